#pragma once
/// Manipulation: a mouse and keys as a transform of what is chosen, by a gizmo's part or by G, R and S. Mathematics and
/// states only; the window draws. World coordinates are those of the scene, relative to its origin; pixels, y down.
///
///   Manipulation drag(Manipulation::Kind::Translate, gizmo, part, at);      // a press on the gizmo, or G with
///   GizmoPart::Screen drag.move_mouse(at, camera, size, modifiers);                           // each Move event
///   drag.press(key, modifiers);                                             // X, Shift+X, digits, Enter, Esc: true if
///   used session.drag_to(drag.motion());  show(drag.text()); if (drag.state() == Confirmed) session.end_drag(); else
///   if (... Cancelled) session.cancel_drag();

#include <string>
#include <vector>

#include "apps/editor/marks.h"
#include "engine/gpu/camera.h"

namespace sinew::editor {

/// What of a gizmo the mouse has hold of. PlaneX moves along the other two axes, or scales them.
enum class GizmoPart { None, X, Y, Z, PlaneX, PlaneY, PlaneZ, Screen };

enum class GizmoKind { Translate, Rotate, Scale };
inline constexpr double least_scale = 0.01;  ///< nothing is scaled by less

struct Gizmo {
  GizmoKind kind = GizmoKind::Translate;
  Vec3 centre = Vec3::Zero();
  Mat3 axes = Mat3::Identity();  ///< columns, unit: world axes, or the handle's own
  double length = 84;            ///< of an axis that is seen from the side, pixels
};

/// A part as lines in the picture, for drawing and for hit testing alike, far ones first: arrows (Translate; planes are
/// filled squares), rings (Rotate; only the half of an axis ring that faces the eye), or axes with a square in the
/// middle for all of them (Scale). An axis seen end-on has none.
struct GizmoStroke {
  GizmoPart part;
  std::vector<Eigen::Vector2d> points;  ///< pixels
  bool closed = false;                  ///< a square or a whole ring
  bool filled = false;
  double fade = 1;  ///< opacity: an axis fades as it turns end-on
};
std::vector<GizmoStroke> gizmo_strokes(const Gizmo& gizmo, const gpu::Camera& camera, const Eigen::Vector2d& size);

/// The part within `reach` pixels of the mouse, nearest first.
GizmoPart hit_gizmo(const Gizmo& gizmo, const gpu::Camera& camera, const Eigen::Vector2d& size,
                    const Eigen::Vector2d& at, double reach = 6);

/// Which handle's ball is under the mouse; the one nearest to the eye of several.
std::optional<std::size_t> hit_handle(std::span<const Vec3> balls, const gpu::Camera& camera,
                                      const Eigen::Vector2d& size, const Eigen::Vector2d& at, double reach = 10);

class Manipulation {
 public:
  enum class State { Running, Confirmed, Cancelled };

  /// Begins at a mouse position. `part`: None and Screen follow the mouse in the plane of the picture (Translate), turn
  /// about the line of sight (Rotate) or scale evenly (Scale): by how much farther the mouse is from the middle, or
  /// where it begins there, by its way right and up. `snap`: step with Ctrl, world lengths; rotations step by 5
  /// degrees, scales by a tenth.
  Manipulation(const Gizmo& gizmo, GizmoPart part, const Eigen::Vector2d& at, double snap = 0);

  /// Shift makes the motion ten times finer from here on, Ctrl snaps.
  void move_mouse(const Eigen::Vector2d& at, const gpu::Camera& camera, const Eigen::Vector2d& size, int modifiers);

  /// X, Y, Z: along or about that axis, again: free; Shift+X: the other two (Translate, Scale). Digits, '.', '-'
  /// and Backspace: a typed length, angle or factor in place of the mouse; in the plane of the picture a typed length
  /// goes along X. Enter confirms, Esc cancels. False: not one of these, nothing happened.
  bool press(int key, int modifiers);
  void confirm() { state_ = State::Confirmed; }
  void cancel();

  State state() const { return state_; }
  /// From where it began; the identity once cancelled.
  const Transform& motion() const { return motion_; }
  GizmoKind kind() const { return gizmo_.kind; }
  GizmoPart part() const { return part_; }
  /// The measure beside the cursor: "0.021, 0.034, -0.006", "X 0.25", "38.2°", "Z [12.5]", "× 1.25".
  std::string text() const;
  /// World line of the axis it is held to, to draw: through the centre; zero where there is none.
  Vec3 axis() const;

 private:
  void solve();
  Vec3 translation() const;
  Mat3 stretch() const;
  double factor() const;
  Vec3 translation_along(const Vec3& axis) const;
  Vec3 translation_in(const Vec3& normal) const;
  void turn(const Eigen::Vector2d& from, const Eigen::Vector2d& to);
  std::optional<double> typed() const;

  Gizmo gizmo_;
  GizmoPart part_, grabbed_;               ///< grabbed_: where it began
  Eigen::Vector2d last_, begin_, cursor_;  ///< cursor_: last_, slowed where Shift was held
  gpu::Camera camera_;
  Eigen::Vector2d size_{0, 0};
  double snap_ = 0, degrees_ = 0;
  bool snapping_ = false, seen_ = false;
  std::string typed_;
  Transform motion_;
  State state_ = State::Running;
};

}  // namespace sinew::editor
