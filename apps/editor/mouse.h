#pragma once
/// Mouse: what mouse and keys do in the viewport: navigation, strokes of the selection tools, handles and their gizmo.

#include <optional>
#include <vector>

#include "apps/editor/commands.h"
#include "apps/editor/input.h"
#include "apps/editor/tools.h"

namespace sinew::editor {

class Mouse {
 public:
  explicit Mouse(Context& context) : context_(context) {}

  /// `over_ui`: a panel has the mouse; a press there is the panel's, what began in the viewport goes on.
  void handle(const InputEvent& event, bool over_ui);
  /// True where the key was used.
  bool press(int key, int modifiers);

  bool navigating() const { return navigation_ != NavigationAction::None; }
  bool stroking() const { return stroke_.has_value(); }
  bool dragging() const { return context_.view.manipulation.has_value(); }
  /// The mouse is the viewport's wherever it goes; not between the clicks of a polygon.
  bool busy() const { return navigating() || (stroking() && !in_polygon()) || dragging(); }

  /// A stroke of a selection tool that is being drawn: corner and opposite, the way of the mouse, or the corners of a
  /// polygon so far.
  struct Stroke {
    Tool tool = Tool::Box;
    SelectMode mode = SelectMode::Replace;
    std::vector<Eigen::Vector2d> points;
  };
  const std::optional<Stroke>& stroke() const { return stroke_; }
  bool in_polygon() const { return stroke_ && stroke_->tool == Tool::Polygon; }
  /// A click here closes the polygon.
  bool closes_polygon() const;
  /// The middle of the sphere brush: the surface under the mouse.
  std::optional<Vec3> ball();

  /// The gizmo of the chosen handle, where there is one, in the pixels of this display.
  std::optional<Gizmo> gizmo() const;
  /// What of it, or which handle, is under the mouse.
  GizmoPart hovered_part() const;
  std::optional<std::size_t> hovered_handle() const;

 private:
  void press_button(const InputEvent& event);
  void press_left(int modifiers);
  void release_button(const InputEvent& event);
  void move(const InputEvent& event);
  void wheel(double steps);
  void click(int modifiers);
  void double_click();
  void finish_manipulation();
  void end_stroke();
  void cut();
  void brush(const Eigen::Vector2d& from, const Eigen::Vector2d& to);
  void paint_ball();
  void add_corner();
  bool press_in_polygon(int key);
  bool press_while_choosing(int key);
  const ScreenPoints& screen();
  std::optional<Vec3> point_under(const Eigen::Vector2d& at);
  std::vector<Vec3> balls() const;

  Context& context_;
  ScreenPoints screen_;
  NavigationAction navigation_ = NavigationAction::None;
  MouseButton navigating_button_ = MouseButton::Left;
  std::optional<Vec3> grabbed_;  ///< what a pan or zoom holds on to
  std::optional<Vec3> wheel_under_;
  Eigen::Vector2d wheel_at_{-1, -1};
  std::optional<Stroke> stroke_;
  std::optional<Vec3> ball_at_;  ///< of the stroke of the sphere brush, last
  bool left_down_ = false, moved_ = false;
  Eigen::Vector2d pressed_at_{0, 0}, last_{0, 0};
  int modifiers_ = 0;
  std::optional<std::size_t> pressed_handle_;
  double last_click_ = -1;
  Eigen::Vector2d last_click_at_{0, 0};
};

}  // namespace sinew::editor
