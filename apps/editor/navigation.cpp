#include "apps/editor/navigation.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace sinew::editor {

namespace {

using gpu::Camera;
using gpu::UpAxis;
using Vec3 = Eigen::Vector3d;

constexpr double pi = std::numbers::pi;
/// The end of the way up or down: beyond it the horizon would turn over.
constexpr double steepest = 89.9 * pi / 180;

constexpr std::array bindings{
    NavigationBinding{NavigationPreset::Blender, MouseButton::Middle, 0, NavigationAction::Orbit,
                      "middle button: orbit"},
    NavigationBinding{NavigationPreset::Blender, MouseButton::Middle, modifier::shift, NavigationAction::Pan,
                      "Shift + middle button: pan"},
    NavigationBinding{NavigationPreset::Blender, MouseButton::Middle, modifier::control, NavigationAction::Zoom,
                      "Ctrl + middle button: zoom"},
    NavigationBinding{NavigationPreset::Maya, MouseButton::Left, modifier::alt, NavigationAction::Orbit,
                      "Alt + left button: orbit"},
    NavigationBinding{NavigationPreset::Maya, MouseButton::Middle, modifier::alt, NavigationAction::Pan,
                      "Alt + middle button: pan"},
    NavigationBinding{NavigationPreset::Maya, MouseButton::Right, modifier::alt, NavigationAction::Zoom,
                      "Alt + right button: zoom"},
    NavigationBinding{NavigationPreset::Scan, MouseButton::Left, 0, NavigationAction::Orbit, "left button: orbit"},
    NavigationBinding{NavigationPreset::Scan, MouseButton::Right, 0, NavigationAction::Pan, "right button: pan"},
    NavigationBinding{NavigationPreset::Scan, MouseButton::Middle, 0, NavigationAction::Pan, "middle button: pan"},
    NavigationBinding{NavigationPreset::Scan, MouseButton::Middle, modifier::shift, NavigationAction::Zoom,
                      "Shift + middle button: zoom"},
};

/// A level direction of view: where the picture's right points, and how far the eye is above the target.
struct Heading {
  double azimuth = 0, elevation = 0;  ///< radians
};

struct LevelAxes {
  Vec3 up, first, second;  ///< right = cos(azimuth) first + sin(azimuth) second
};

LevelAxes level_axes(UpAxis up) {
  const Vec3 u = gpu::up_vector(up), first = Vec3::UnitX();
  return {u, first, u.cross(first)};
}

Heading heading_of(const Camera& camera, UpAxis up) {
  const LevelAxes axes = level_axes(up);
  const Vec3 back = (camera.eye - camera.target).normalized();
  const Vec3 right = camera.up.cross(back);
  // Level already unless the up axis has just changed; then what is level of the present right, or of the view itself.
  Vec3 level = right - axes.up * axes.up.dot(right);
  if (!(level.norm() > 1e-6 * right.norm())) level = axes.up.cross(back);
  Heading heading;
  heading.elevation = std::asin(std::clamp(back.dot(axes.up), -1.0, 1.0));
  if (level.norm() > 1e-9) heading.azimuth = std::atan2(level.dot(axes.second), level.dot(axes.first));
  return heading;
}

void set_heading(Camera& camera, const Heading& heading, double distance, UpAxis up) {
  const LevelAxes axes = level_axes(up);
  const Vec3 right = std::cos(heading.azimuth) * axes.first + std::sin(heading.azimuth) * axes.second;
  const Vec3 back = std::cos(heading.elevation) * right.cross(axes.up) + std::sin(heading.elevation) * axes.up;
  camera.eye = camera.target + distance * back;
  camera.up = back.cross(right);  // well defined at the poles too
}

}  // namespace

std::span<const NavigationBinding> navigation_bindings() {
  return bindings;
}

const char* name_of(NavigationPreset preset) {
  switch (preset) {
    case NavigationPreset::Blender: return "Blender";
    case NavigationPreset::Maya: return "Maya / Houdini";
    case NavigationPreset::Scan: return "Scan";
  }
  return "";
}

NavigationAction navigation_action(NavigationPreset preset, MouseButton button, int modifiers, bool over_nothing) {
  for (const NavigationBinding& row : bindings) {
    if (row.preset != preset || row.button != button) continue;
    if (row.modifiers != (modifiers & (modifier::shift | modifier::control | modifier::alt))) continue;
    const bool shared_with_tools = row.button == MouseButton::Left && row.modifiers == 0;
    if (!shared_with_tools || over_nothing) return row.action;
  }
  return NavigationAction::None;
}

void orbit(Camera& camera, const Eigen::Vector2d& pixels, const Eigen::Vector2d& size, UpAxis up) {
  Heading heading = heading_of(camera, up);
  heading.azimuth -= pixels.x() / size.x() * 2 * pi;
  heading.elevation = std::clamp(heading.elevation + pixels.y() / size.y() * pi, -steepest, steepest);
  set_heading(camera, heading, camera.distance(), up);
}

void pan(Camera& camera, const Eigen::Vector2d& pixels, const Eigen::Vector2d& size,
         const std::optional<Eigen::Vector3d>& grabbed) {
  const Eigen::Matrix4d view = gpu::view_matrix(camera);
  const double pixel = gpu::pixel_size(camera, size.y(), grabbed.value_or(camera.target));
  const Vec3 by = pixel * (-pixels.x() * view.block<1, 3>(0, 0) + pixels.y() * view.block<1, 3>(1, 0)).transpose();
  camera.eye += by;
  camera.target += by;
}

void zoom(Camera& camera, double factor, const Eigen::Vector2d& at, const Eigen::Vector2d& size, double extent,
          const std::optional<Eigen::Vector3d>& under) {
  const double least = 1e-4 * extent, most = 50 * extent;
  if (extent > 0) factor = std::clamp(factor, least / camera.distance(), most / camera.distance());
  Vec3 anchor = camera.target;
  if (under) {
    anchor = *under;
  } else if (Vec3 target; gpu::project(camera, size, camera.target, target)) {
    anchor = gpu::unproject(camera, size, at, target.z());
  }
  if (!anchor.allFinite()) anchor = camera.target;
  camera.eye = anchor + factor * (camera.eye - anchor);
  camera.target = anchor + factor * (camera.target - anchor);
}

double zoom_of_wheel(double steps) {
  return std::pow(0.88, std::clamp(steps, -20.0, 20.0));
}

double zoom_of_drag(double pixels_down) {
  return std::pow(1.005, std::clamp(pixels_down, -2000.0, 2000.0));
}

Camera framed(Camera camera, const Bounds& bounds, double aspect, double fill) {
  gpu::frame_bounds(camera, bounds, aspect, fill);
  return camera;
}

Camera with_pivot(Camera camera, const Eigen::Vector3d& pivot) {
  camera.eye += pivot - camera.target;
  camera.target = pivot;
  return camera;
}

Camera viewed(Camera camera, const char* name, UpAxis up) {
  gpu::look_from(camera, name, up);
  return camera;
}

Camera levelled(Camera camera, UpAxis up) {
  Heading heading = heading_of(camera, up);
  heading.elevation = std::clamp(heading.elevation, -steepest, steepest);
  set_heading(camera, heading, camera.distance(), up);
  return camera;
}

CameraGlide::CameraGlide(const Camera& from, const Camera& to, UpAxis up, double seconds)
    : from_(from), to_(to), up_(up), seconds_(seconds) {}

Camera CameraGlide::advance(double seconds) {
  elapsed_ += std::max(0.0, seconds);
  if (!running()) return to_;
  const double x = elapsed_ / seconds_, s = x * x * (3 - 2 * x);
  const Heading a = heading_of(from_, up_), b = heading_of(to_, up_);
  const double turn = std::remainder(b.azimuth - a.azimuth, 2 * pi);
  Camera camera = to_;
  camera.target = (1 - s) * from_.target + s * to_.target;
  camera.fov = (1 - s) * from_.fov + s * to_.fov;
  camera.shift = (1 - s) * from_.shift + s * to_.shift;
  const double distance = std::pow(from_.distance(), 1 - s) * std::pow(to_.distance(), s);
  set_heading(camera, {a.azimuth + s * turn, (1 - s) * a.elevation + s * b.elevation}, distance, up_);
  return camera;
}

}  // namespace sinew::editor
