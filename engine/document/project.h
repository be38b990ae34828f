#pragma once
/// Project: the plain data that the user made. All else is derived from it and can be thrown away at any moment. A
/// value type: big arrays are shared and never changed, so a copy costs little and undo is the previous Project.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/document/json.h"
#include "engine/geometry/shape.h"
#include "engine/geometry/skin_weights.h"

namespace sinew::document {

/// An array that is shared by copies and never changed. Equal by content.
template <class T>
class Shared {
 public:
  Shared() = default;
  explicit Shared(std::vector<T> values) : values_(std::make_shared<const std::vector<T>>(std::move(values))) {}
  const std::vector<T>& get() const {
    static const std::vector<T> none;
    return values_ ? *values_ : none;
  }
  bool operator==(const Shared& other) const { return values_ == other.values_ || get() == other.get(); }

 private:
  std::shared_ptr<const std::vector<T>> values_;
};

struct SelectAll {
  bool all = true;
  bool operator==(const SelectAll&) const = default;
};
struct SelectIndices {
  Shared<Index> points;  ///< from 0, in the point order of the file
  bool operator==(const SelectIndices&) const = default;
};
struct SelectBox {
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();
  bool operator==(const SelectBox&) const = default;
};
struct SelectSphere {
  Vec3 center = Vec3::Zero();
  double radius = 0;
  bool operator==(const SelectSphere&) const = default;
};
struct SelectNearest {
  Vec3 to = Vec3::Zero();  ///< one point; of equally near ones the lowest index
  bool operator==(const SelectNearest&) const = default;
};
struct SelectComponent {
  Index number = 0;  ///< of connected_components (topology.h)
  bool operator==(const SelectComponent&) const = default;
};
struct SelectLabels {
  std::string path;  ///< from the working folder; in a file from the file's folder
  int value = 0;
  bool operator==(const SelectLabels&) const = default;
};

/// Places in the space of the shape instead of its points: of handles alone. Such a handle pulls what is there along.
struct SelectPlaces {
  Shared<Vec3> at;
  bool operator==(const SelectPlaces&) const = default;
};

/// Which points: interface.md, SELECTION. Coordinates are the file's own, before any edit, borders included.
struct Selection {
  std::variant<SelectAll, SelectIndices, SelectBox, SelectSphere, SelectNearest, SelectComponent, SelectLabels,
               SelectPlaces>
      what;
  Place place;
  /// Of a sequence: where the points are looked for; absent: the layer's frame.
  std::optional<int> frame = std::nullopt;
  bool operator==(const Selection&) const = default;
};

struct Rotation {
  Vec3 axis = Vec3::UnitZ();  ///< any length above 0; right-handed
  double degrees = 0;
  std::optional<Vec3> about;  ///< absent: the mean of the handle's points
  bool operator==(const Rotation&) const = default;
};

/// Where the points of a handle are to be. p -> A (R (p - about) + about) + t + move, in the order: rotate, matrix,
/// move; or `to`, the targets themselves, one a point in the order of the selection. All in the file's coordinates.
struct Motion {
  std::optional<Vec3> move;
  std::optional<Rotation> rotate;
  std::optional<Eigen::Matrix4d> matrix;  ///< [A t; 0 0 0 1]
  Shared<Vec3> to;
  bool operator==(const Motion&) const = default;
};

struct HandleEdit {
  Selection points;
  Motion motion;
  Place place;
  std::string name = {};  ///< what tables call it; may be empty
  bool operator==(const HandleEdit&) const = default;
};

struct Stiffness {
  Selection points;
  double factor = 1;
  bool operator==(const Stiffness&) const = default;
};

/// How the motions of a key become those of the next.
enum class Interpolation { Linear, Smooth, Hold };

/// Motions of the layer's handles, in their order, at a frame; handles beyond them keep their own. They are meant for
/// the handles as they are at that frame; at other frames they are carried along with the handle's points (keys.h).
struct Key {
  int frame = 1;
  std::vector<Motion> handles;
  std::vector<std::optional<double>> example_weights;  ///< in place of the layer's; empty: these
  Interpolation interpolation = Interpolation::Linear;
  Place place;
  bool operator==(const Key&) const = default;
};

/// A curtain that no influence passes: Cut of deformer.h, in the file's coordinates.
struct CutEdit {
  std::vector<Vec3> path;  ///< two points or more
  Vec3 depth = Vec3::Zero();
  Place place;
  bool operator==(const CutEdit&) const = default;
};

/// The path of one particle of a stream, sampled at fixed time steps: the graph's nodes, each joined to the next
/// [Sumner et al. 2007, section 5]. A layer with a path bends points wherever they are in space, so that their number
/// and order may change from frame to frame.
struct ParticlePath {
  std::optional<double> id;  ///< of the particle (its attribute of kind id); absent: the one that lives longest
  int every = 1;             ///< frames from one sample to the next
  Shared<Vec3> points;       ///< the samples themselves, in the file's coordinates; then no frame is read to find them
  Place place;
  bool operator==(const ParticlePath&) const = default;
};

/// A marker of a motion and where it belongs on the shape, in the file's coordinates.
struct MarkerMatch {
  std::string name;
  Vec3 place = Vec3::Zero();
  Place at;
  bool operator==(const MarkerMatch&) const = default;
};

/// Captured markers, or the joints of a skeleton, as handles: each pulls the place along that it has in the first
/// frame. Aligned with the shape there: p -> scale R p + move, by the matches where there are any (at least three),
/// else by `rotate` and `move` where there are; without any of these the markers are laid on the shape (surface_fit.h).
/// Where the shape stands in another pose than the markers, `corresponding` pulls the places of the matches themselves,
/// and no other markers.
struct MarkersEdit {
  std::string path;               ///< as SelectLabels::path
  std::optional<int> first;       ///< frame of the motion that is aligned; absent: its first
  std::vector<std::string> only;  ///< names of those that are used; empty: all
  std::vector<MarkerMatch> matches;
  bool corresponding = false;
  std::optional<double> scale;  ///< absent: fitted to the matches or the shape; with `rotate` or `move` 1
  std::optional<Rotation> rotate;
  std::optional<Vec3> move;
  int bridge = 12;  ///< gaps of up to so many frames are bridged; in longer ones the marker is released
  Place place;
  bool operator==(const MarkersEdit&) const = default;
};

/// A setting as the user gave it: a number, or the name of a choice.
struct SettingEdit {
  std::string name;
  std::variant<double, std::string> value;
  Place place;
  bool operator==(const SettingEdit&) const = default;
};

struct Layer {
  std::string name;  ///< what the window calls it; may be empty
  bool on = true;    ///< off: passed over
  std::string method = "graph";
  std::vector<SettingEdit> settings;
  std::optional<int> frame;  ///< of a sequence: that the structure is made at; absent: the first key's, or the first
  std::optional<ParticlePath> path;
  std::vector<CutEdit> cuts;
  std::string tets;  ///< a file of tets for the method to use, as SelectLabels::path; empty: it makes some
  std::optional<MarkersEdit> markers;
  std::vector<Selection> nodes;  ///< points that the method is to build its structure on; empty: it chooses
  std::vector<Selection> fixed;
  std::vector<HandleEdit> handles;
  std::vector<Selection> rigid;
  std::vector<Stiffness> stiffness;
  std::vector<std::string> examples;  ///< paths, as SelectLabels::path; each one pose or several (poses.h)
  /// Of the first examples, how much of each there is to be; null, or none given: what suits the handles, without any
  /// 0.
  std::vector<std::optional<double>> example_weights;
  std::string examples_of;  ///< a file that the examples are poses of, as SelectLabels::path; empty: the shape itself
  std::vector<Key> keys;
  Shared<Affine> start;  ///< the pose to start the solve from (Deformer::pose); empty: rest
  Place place;
  bool operator==(const Layer&) const = default;
};

/// Whether what a method makes its structure of is the same in both.
bool same_structure(const Layer& a, const Layer& b);

/// Of the inputs as they were when the edit was saved (input_hash.h), one an input, or none. No part of the edit.
struct InputHashes {
  std::vector<std::string> of;
  bool operator==(const InputHashes&) const { return true; }
};

struct Project {
  std::vector<std::string> inputs;  ///< paths, as SelectLabels::path
  std::vector<Layer> layers;        ///< the first works on the input, each other on the output of the one before
  InputHashes hashes;
  bool operator==(const Project&) const = default;
};

}  // namespace sinew::document
