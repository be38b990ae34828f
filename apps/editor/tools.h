#pragma once
/// Selection tools: which points lie under a click, in a box, in a lasso or under a brush. Points are projected once a
/// picture into ScreenPoints; each tool then is one pass over them. Pixels of the picture, y down. On 1,000,000 points
/// projection and each tool stay within a frame of 33 ms on two cores (tests/apps/editor_core_test.cpp prints the
/// times).
///
///   screen_points.update(camera, size, session.bent_positions(), session.bent_version());   // free where nothing
///   moved const PointSet touched = in_box(screen_points, corner, opposite, Depth::VisibleOnly);
///   session.select(touched, select_mode(modifiers));

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "apps/editor/point_set.h"
#include "engine/gpu/camera.h"

namespace sinew::editor {

/// Whether a tool reaches what stands behind: the switch "visible only / through".
enum class Depth { VisibleOnly, Through };

struct ScreenRect {
  Eigen::Vector2d min, max;  ///< pixels
};

/// Ids of the points that are drawn in a part of the picture, in any order, any number of times each: GPU picking.
/// Where a session has none, what hides what is found by a coarse depth picture on the CPU.
using VisibleIds = std::function<std::vector<Index>(const ScreenRect&)>;

class ScreenPoints {
 public:
  /// Projects all points; nothing is done where camera, size and version are those of the last call. Points behind the
  /// eye or not finite are nowhere. `version` changes whenever a position does.
  void update(const gpu::Camera& camera, const Eigen::Vector2d& size, std::span<const Vec3> positions,
              std::uint64_t version);

  /// Points that are nowhere.
  void set_hidden(const PointSet& hidden);

  /// Source of visibility; empty: the depth picture of the CPU.
  void set_visible_ids(VisibleIds ids);

  std::size_t size() const { return x_.size(); }
  /// Pixel position; NaN where it is nowhere.
  Eigen::Vector2f at(std::size_t i) const { return {x_[i], y_[i]}; }
  /// Distance along the view, in the shape's unit.
  float depth(std::size_t i) const { return depth_[i]; }

  /// Length that one pixel covers at a depth.
  float pixel_length(float depth) const;
  const Eigen::Vector2d& picture_size() const { return size_; }

  std::span<const float> x() const { return x_; }
  std::span<const float> y() const { return y_; }
  /// Points that nothing stands before, of those within `rect` (others are in or out as it comes).
  const PointSet& visible(const ScreenRect& rect) const;

 private:
  void splat_depth() const;

  gpu::Camera camera_;
  Eigen::Vector2d size_{0, 0};
  std::uint64_t version_ = 0;
  bool projected_ = false;
  std::vector<float> x_, y_, depth_;
  PointSet hidden_;
  VisibleIds ids_;
  // Found when a tool first asks for it after a change.
  mutable bool splatted_ = false;
  mutable PointSet visible_;
};

/// The point nearest to the eye within `radius` pixels of the click, and of those near the front surface the one
/// nearest to the click; nothing where there is none.
std::optional<Index> click_point(const ScreenPoints& points, const Eigen::Vector2d& at, double radius = 8);

/// Corners in any order.
PointSet in_box(const ScreenPoints& points, const Eigen::Vector2d& corner, const Eigen::Vector2d& opposite,
                Depth depth);

/// A closed polygon, by the even-odd rule; a drawn lasso may have any number of corners and cross itself.
PointSet in_polygon(const ScreenPoints& points, std::span<const Eigen::Vector2d> corners, Depth depth);

/// A brush of `radius` pixels drawn from one place of the mouse to the next (the same: a dab).
PointSet in_stroke(const ScreenPoints& points, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double radius,
                   Depth depth);

}  // namespace sinew::editor
