#pragma once
/// Navigation: what the mouse does to a camera, as pure functions, and which button does it in each preset. Pixels of
/// the picture, y down; `size` is the picture's. No function flips or rolls the view: the horizon stays level, and
/// looking straight up or down is the end of the way.

#include <Eigen/Core>
#include <optional>
#include <span>

#include "apps/editor/keys.h"
#include "engine/gpu/camera.h"

namespace sinew::editor {

enum class NavigationPreset { Blender, Maya, Scan };  ///< Maya: and Houdini, with Alt
enum class NavigationAction { None, Orbit, Pan, Zoom };

/// A row of the table of presets.
struct NavigationBinding {
  NavigationPreset preset;
  MouseButton button;
  int modifiers;  ///< exactly these of Shift, Ctrl, Alt
  NavigationAction action;
  const char* help;  ///< "middle button: orbit"
};
std::span<const NavigationBinding> navigation_bindings();
const char* name_of(NavigationPreset preset);  ///< "Blender", "Maya / Houdini", "Scan"

/// What a press of a button begins. None: it is the tool's. In the Scan preset the left button orbits only where
/// `over_nothing`: no tool, no handle and no gizmo wants it there.
NavigationAction navigation_action(NavigationPreset preset, MouseButton button, int modifiers,
                                   bool over_nothing = false);

/// A drag of `pixels`: the picture's width is a turn of 360 degrees about the up axis, its height 180 degrees up or
/// down.
void orbit(gpu::Camera& camera, const Eigen::Vector2d& pixels, const Eigen::Vector2d& size, gpu::UpAxis up);

/// Moves the view so that `grabbed` (the target, or what was under the mouse) stays under it.
void pan(gpu::Camera& camera, const Eigen::Vector2d& pixels, const Eigen::Vector2d& size,
         const std::optional<Eigen::Vector3d>& grabbed = {});

/// Scales the distance to what is under the mouse by `factor` (< 1: nearer); that place stays where it is in the
/// picture. `under` is the point there; without, a point at the target's depth. `extent`: the diagonal of all that is
/// shown, which bounds the distance.
void zoom(gpu::Camera& camera, double factor, const Eigen::Vector2d& at, const Eigen::Vector2d& size, double extent,
          const std::optional<Eigen::Vector3d>& under = {});
/// Of a wheel's step (up is nearer), and of a drag up or down.
double zoom_of_wheel(double steps);
double zoom_of_drag(double pixels_down);

/// `bounds` in the picture's free part from the same direction. `fill` as frame_bounds.
gpu::Camera framed(gpu::Camera camera, const Bounds& bounds, double aspect, double fill = 0.8);
/// The camera that has `pivot` in its middle, from the same direction and distance.
gpu::Camera with_pivot(gpu::Camera camera, const Eigen::Vector3d& pivot);
/// "front" ... of look_from.
gpu::Camera viewed(gpu::Camera camera, const char* name, gpu::UpAxis up);
/// The same direction with another up axis, level.
gpu::Camera levelled(gpu::Camera camera, gpu::UpAxis up);

/// A glide from one camera to another: the directions turn level about the up axis, the target moves straight, the
/// distance changes by a constant factor. A mouse that navigates ends it.
class CameraGlide {
 public:
  CameraGlide() = default;
  CameraGlide(const gpu::Camera& from, const gpu::Camera& to, gpu::UpAxis up, double seconds = 0.25);
  bool running() const { return elapsed_ < seconds_; }
  /// The camera after `seconds` more.
  gpu::Camera advance(double seconds);
  void stop() { elapsed_ = seconds_; }

 private:
  gpu::Camera from_, to_;
  gpu::UpAxis up_ = gpu::UpAxis::Y;
  double seconds_ = 0, elapsed_ = 0;
};

}  // namespace sinew::editor
