#pragma once
/// DetailController: how many points to draw while something moves, so that a frame keeps its time. It learns from the
/// frames it is told of: the time of a frame is taken as  base + cost * points  and the cost follows what is measured.
/// At rest the count doubles frame by frame up to all points.
///
///   const std::size_t count = detail.begin_frame(points, moving);   // CloudItem::count
///   ... draw and wait for it ...
///   detail.end_frame(seconds);                                      // of drawing, without waiting for input
///   if (!detail.complete()) ask for one more frame;

#include <cstddef>

namespace sinew::editor {

struct DetailSettings {
  double frame_seconds = 0.024;  ///< what a moving frame may take: with the solve before it, 33 ms from the mouse on
  std::size_t least = 5000;      ///< never fewer points than these (or all, if the shape has fewer)
  double rest_seconds = 0.15;    ///< without motion for so long: at rest
};

class DetailController {
 public:
  explicit DetailController(const DetailSettings& settings = {}) : settings_(settings) {}

  /// How many of `total` points this frame draws. `moving`: the camera, the shape or a tool's overlay changes.
  /// `now`: seconds on any clock that only goes forward.
  std::size_t begin_frame(std::size_t total, bool moving, double now);
  void end_frame(double seconds);

  /// The last frame showed all points.
  bool complete() const { return drawn_ == total_; }
  std::size_t drawn() const { return drawn_; }

 private:
  DetailSettings settings_;
  std::size_t total_ = 0, drawn_ = 0;
  double base_ = 0.004, cost_ = 1e-7;  ///< seconds a frame, seconds a point
  double last_motion_ = -1e9;
};

}  // namespace sinew::editor
