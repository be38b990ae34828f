#pragma once
/// Workspace: what is derived from a Project and its input, kept from one update to the next and thrown away at any
/// moment: a deformer per layer, its weights, and its pose at the frames that matter.
///
/// Frames. A layer's structure is made at one frame (Footage::frame_of) and carried along to the others
/// (Deformer::follow). At a key the solve starts from rest; at any other frame from the solutions of the keys around
/// it, blended, and from nothing else: so the answer of a frame is the same whatever was solved before, and frames can
/// be shared out to any number of programs. A layer without keys has one, with the handles' motions, where its
/// structure is made.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/document/footage.h"
#include "engine/document/markers.h"
#include "engine/document/project.h"
#include "engine/geometry/deformer.h"

namespace sinew::document {

/// An example of a layer: what to call it and where it comes from.
struct ExampleName {
  std::string name, path;  ///< of the pose, of its file (poses.h)
  std::size_t entry = 0;   ///< of Layer::examples,
  std::string entry_path;  ///< and what stands there
};

/// A layer that is on, after an update.
struct LayerResult {
  std::size_t layer = 0;                       ///< its index in Project::layers
  std::shared_ptr<const SkinWeights> weights;  ///< of all points of the frame's input
  std::shared_ptr<const Pose> pose;
  std::shared_ptr<const Deformer::Structure> structure;  ///< of the layer's deformer at the frame, at rest, to draw
  SolveReport report;
  Constraints constraints;  ///< that the pose was solved for; points of the layer's rest (Workspace::rest)
  /// Whether they are points of the frame's input, too; else of a stream's gathered ones (footage.h).
  bool of_frame = true;
  std::vector<Motion> motions;  ///< of the handles at the frame, as a key there would have them
  std::vector<Vec3> centres;    ///< means of the handles' points at the frame, where the layer starts from
  std::shared_ptr<const std::vector<double>> map_energy;  ///< Deformer::map_energy of the pose
  std::vector<ExampleName> examples;                      ///< in the order of the report's example_weights
  bool solved = false;       ///< false: an earlier pose is carried along, because a layer below is being dragged
  double build_seconds = 0;  ///< making the deformer: its structure and the weights of the points
  std::shared_ptr<const Markers> markers;  ///< the motion that drives the layer; null where there is none
};

struct UpdateOptions {
  std::optional<int> frame;  ///< absent: the first
  SolveOptions solve;        ///< on_iteration is set by update()
  /// Called while a deformer is made ("building") and after each iteration ("solving", with 0), fraction 0..1;
  /// false stops. May be empty.
  std::function<bool(const char* what, std::size_t layer, double fraction)> progress;
  /// Called after each iteration with all layers so far; false stops. May be empty.
  std::function<bool(const std::vector<LayerResult>&)> on_iteration;
};

struct UpdateResult {
  std::vector<LayerResult> layers;
  bool stopped = false;  ///< a callback said so; `layers` may then lack some
};

class Workspace {
 public:
  /// `methods` must outlive the workspace.
  Workspace(std::shared_ptr<const Sequence> input, std::span<const Method> methods);
  Workspace(std::shared_ptr<const Shape> still, std::span<const Method> methods);

  const Sequence& sequence() const { return footage_.sequence(); }
  /// Whether the layers of the last update bend points wherever they are in space (footage.h).
  bool stream() const { return footage_.stream(); }
  /// The input's shape at a frame.
  std::shared_ptr<const Shape> input(int frame) { return footage_.input(frame); }

  /// Brings everything up to date with `layers` (Project::layers) at a frame. What did not change is not done again: a
  /// deformer is remade when its method, its settings, its structure or the output of the layers below changed, a pose
  /// is solved again (of a still from where it is) when constraints or the wanted quality changed. With
  /// Quality::Interactive a layer above one that moved is not remade: its last pose is carried along. Throws
  /// InputError.
  UpdateResult update(std::span<const Layer> layers, const UpdateOptions& options);

  /// Deformer of a layer as it is at the frame of the last update; null where there is none.
  const Deformer* deformer(std::size_t layer) const;
  /// The motion that drives a layer, as of the last update; null where there is none.
  const Markers* markers(std::size_t layer) const;
  /// The rest shape of a layer's deformer at the frame of the last update: the output of the layers below.
  std::shared_ptr<const Shape> rest(std::size_t layer) const;

 private:
  /// A layer's solution at a frame.
  struct Solved {
    std::shared_ptr<const Shape> rest;
    Constraints constraints;
    std::vector<Motion> motions;
    std::vector<Vec3> centres;
    std::shared_ptr<const Pose> from, to;  ///< solutions of the keys that it started from; null at a key
    std::shared_ptr<const Pose> pose;      ///< null: not solved yet
    std::shared_ptr<const std::vector<double>> map_energy;
    SolveReport report;
    SolveOptions::Quality quality = SolveOptions::Quality::Interactive;
    bool settled = false;                 ///< the last solve was not stopped
    std::shared_ptr<const Shape> output;  ///< rest, bent; null until a layer above asks
  };
  struct Kept {
    Layer layer;                        ///< as it was last solved
    std::shared_ptr<const Shape> base;  ///< what the deformer was made for
    std::shared_ptr<Deformer> deformer;
    std::vector<ExampleName> examples;
    double build_seconds = 0;
    std::optional<Layer> fitted;             ///< the edit that the structure was refined for
    bool grown = false;                      ///< and it was
    std::optional<Marked> marked;            ///< of `layer`
    std::shared_ptr<const Markers> markers;  ///< of `layer`; null where it has none
    std::shared_ptr<const Shape> followed;   ///< the rest shape that the deformer has now
    std::shared_ptr<const Pose> held;        ///< the pose that it has there, where that is one of `solved`
    std::map<int, Solved> solved;
    std::shared_ptr<const Deformer::Structure> structure;  ///< at `followed`; null until it is asked for
    std::shared_ptr<const SkinWeights> weights;            ///< of the points shown
    std::vector<Vec3> bound;                               ///< of a stream: those points; they are bound at
    std::shared_ptr<const Shape> bound_at;                 ///< this rest shape
  };

  bool bring(std::size_t i, int frame);
  bool fit(std::size_t i, int base_frame);
  bool bring_made(std::size_t i, int frame);
  bool make(std::size_t i, const std::shared_ptr<const Shape>& base);
  bool start(std::size_t i, int frame, Solved& now);
  enum class From { Keys, Here };  ///< where a solve begins: as start() says, or where the deformer is
  bool solve(std::size_t i, int frame, Solved& now, From where);
  /// What the keys ask of a layer at a frame.
  struct Wanted {
    Constraints constraints;
    std::vector<Motion> motions;
    std::vector<Vec3> centres;
  };
  std::optional<Wanted> wanted(std::size_t i, int frame, const Shape& rest);
  std::shared_ptr<const Shape> rest_of(std::size_t i, int frame);
  std::shared_ptr<const Shape> output(std::size_t i, int frame);
  void install(Kept& kept, std::shared_ptr<Deformer> deformer);
  void follow(Kept& kept, const std::shared_ptr<const Shape>& rest);
  LayerResult result(std::size_t i, const Solved& solved);
  void forget_frames();

  Footage footage_;
  std::span<const Method> methods_;
  std::vector<Kept> kept_;
  // Of the update that runs:
  std::span<const Layer> layers_;
  const UpdateOptions* options_ = nullptr;
  int frame_ = 0;
  std::vector<LayerResult> done_;
  std::vector<Vec3> points_;  ///< of a stream: the frame's, after the layers done so far
};

/// The keys of a layer, each with a motion for every handle; of a layer without keys, the handles' motions at `frame`.
std::vector<Key> keys_of(const Layer& layer, int frame);

}  // namespace sinew::document
