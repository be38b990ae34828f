#pragma once
/// Footage: the frames of a project's input, all relative to one origin, and the points that layers work on.
///
/// Of a mesh animation (and a still) these are the points of the frame: every frame has the same ones, in the same
/// order. Of a stream, whose points come and go, they are gathered once from all of time: the samples of each layer's
/// path, then the points of each frame that a selection is made at. A frame's own points are then bound by where they
/// are in space. The input is a stream where a layer that is on has a path.

#include <map>
#include <memory>
#include <span>
#include <vector>

#include "engine/document/selection.h"

namespace sinew::document {

class Footage {
 public:
  explicit Footage(std::shared_ptr<const Sequence> sequence);

  const Sequence& sequence() const { return *sequence_; }
  bool still() const { return sequence_->frames.size() == 1; }
  int first_frame() const { return sequence_->frames.front(); }

  /// The shape of a frame, relative to the origin of the first; the last ones used are kept. Throws InputError: no such
  /// frame, or what its reader says.
  std::shared_ptr<const Shape> input(int frame);

  /// Which layers there are: from them follow the gathered points of a stream. Throws InputError.
  void set_layers(std::span<const Layer> layers);
  bool stream() const { return gathered_ != nullptr; }

  /// The points that layers work on, at a frame, before any layer. Throws InputError where a mesh animation's frame has
  /// other points than its first (another count, other ids).
  std::shared_ptr<const Shape> carrier(int frame);

  /// The frame that a layer's structure and its selections are made at.
  int frame_of(const Layer& layer) const;
  /// Points of a selection of that layer, as indices of the carrier. Throws InputError as Selector does.
  std::vector<Index> points(const Layer& layer, const Selection& selection, bool as_written);
  /// Indices of the carrier that are the samples of a layer's path, in order; empty for a layer without.
  std::vector<Index> path_points(const Layer& layer) const;

  /// Throws InputError where the sequence has no such frame (a still has every one); `place` and `what` say who asks.
  void require(int frame, const Place& place, const std::string& what) const;

 private:
  struct Gathering {
    std::vector<ParticlePath> paths;
    std::vector<int> frames;
    bool operator==(const Gathering&) const = default;
  };

  Selector& selector(int frame);
  std::vector<Vec3> samples(const ParticlePath& path);
  void gather();

  std::shared_ptr<const Sequence> sequence_;
  std::vector<std::pair<int, std::shared_ptr<const Shape>>> recent_;  ///< frames last used, the newest last
  std::shared_ptr<const Shape> first_;                                ///< once it was read
  std::map<int, std::unique_ptr<Selector>> selectors_;
  Gathering gathering_;
  std::shared_ptr<const Shape> gathered_;
  std::vector<Index> path_begins_;     ///< of each path of the gathering, and the end of the last
  std::map<int, Index> frame_begins_;  ///< of each frame's points
};

}  // namespace sinew::document
