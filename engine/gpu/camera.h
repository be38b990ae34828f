#pragma once
/// Camera: where the eye is and what it sees, as matrices with reversed depth (1 near, 0 far: float depth is then
/// equally fine everywhere). Right-handed; the view looks along -z, the picture's y grows downwards.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "engine/geometry/bounds.h"

namespace sinew::gpu {

enum class UpAxis { Y, Z };  ///< of the view; shapes are never turned
Eigen::Vector3d up_vector(UpAxis axis);

struct Camera {
  Eigen::Vector3d eye{0, 0, 1}, target{0, 0, 0};  ///< target: what the camera turns about
  Eigen::Vector3d up{0, 1, 0};                    ///< not along eye - target
  double fov = 35;                                ///< full vertical angle, degrees
  bool orthographic = false;                      ///< the picture is then as high as a perspective one is at the target
  double near = 0.01;                             ///< distance from the eye; see fit_depth
  double far = 100;                               ///< orthographic only: a perspective picture has no far end
  /// Where the target stands in the picture, -1..1 with y up: (0, 0) is the middle. For panels that cover one side.
  Eigen::Vector2d shift{0, 0};

  double distance() const { return (eye - target).norm(); }
};

Eigen::Matrix4d view_matrix(const Camera& camera);
Eigen::Matrix4d projection_matrix(const Camera& camera, double aspect);  ///< aspect = width / height
Eigen::Matrix4d clip_matrix(const Camera& camera, double aspect);        ///< projection * view

/// Sets near and far so that all of `bounds` can be seen.
void fit_depth(Camera& camera, const Bounds& bounds);

/// Moves eye and target so that `bounds` fills `fill` of the picture from the same direction, and fits the depth.
/// Empty bounds and single points are framed as if their diagonal were 1.
void frame_bounds(Camera& camera, const Bounds& bounds, double aspect, double fill = 0.8);

/// "front", "back", "left", "right", "top", "bottom" or "iso": `camera` turned so about its target; false where the
/// name is none of these.
bool look_from(Camera& camera, const std::string& name, UpAxis axis);

/// `count` cameras once around the target of this one, by `degrees` in all, the first as it is: of a turntable, which
/// turns to the left. Full turns end a step before where they began. They are as far from the target as the farthest
/// that frames `bounds` in `fill` of the picture; with `fill` 0 as far as this one.
std::vector<Camera> cameras_around(const Camera& camera, UpAxis axis, int count, double degrees, const Bounds& bounds,
                                   double aspect, double fill);

/// The point that is seen at picture position (x, y), in pixels of a size, at a depth of the picture (0 < depth).
Eigen::Vector3d unproject(const Camera& camera, Eigen::Vector2d size, Eigen::Vector2d at, double depth);

/// Pixel position and depth of a point; false where it is behind the eye.
bool project(const Camera& camera, Eigen::Vector2d size, const Eigen::Vector3d& point, Eigen::Vector3d& out);

/// Length at `point` that one pixel of a picture of this height covers.
double pixel_size(const Camera& camera, double height, const Eigen::Vector3d& point);

}  // namespace sinew::gpu
