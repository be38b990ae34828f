#include "apps/editor/mouse.h"

#include "apps/editor/theme.h"

namespace sinew::editor {

namespace {

constexpr double double_click_seconds = 0.35;

double slack() {
  return 4 * static_cast<double>(scale());
}

/// The bit of a key that is a modifier itself; 0 for others.
int modifier_of(int key) {
  switch (key) {
    case key::left_shift:
    case key::right_shift: return modifier::shift;
    case key::left_control:
    case key::right_control: return modifier::control;
    case key::left_alt:
    case key::right_alt: return modifier::alt;
    default: return 0;
  }
}

bool draws_strokes(Tool tool) {
  return tool == Tool::Box || tool == Tool::Lasso || tool == Tool::Polygon || tool == Tool::Brush ||
         tool == Tool::Ball || tool == Tool::Cut;
}

}  // namespace

void Mouse::handle(const InputEvent& event, bool over_ui) {
  if (in_polygon() && (context_.view.tool != Tool::Polygon || !context_.session.has_input())) stroke_.reset();
  switch (event.what) {
    case InputEvent::What::Move: move(event); break;
    case InputEvent::What::Button:
      modifiers_ = event.modifiers & modifier::all;
      if (event.action == 0)
        release_button(event);
      else if (!over_ui)
        press_button(event);
      break;
    case InputEvent::What::Wheel:
      if (!over_ui) wheel(event.y);
      break;
    case InputEvent::What::Key:
      if (const int bit = modifier_of(event.code)) {
        modifiers_ = event.action != 0 ? modifiers_ | bit : modifiers_ & ~bit;
        update_manipulation(context_.session, context_.view, modifiers_);
      }
      break;
    case InputEvent::What::Focus:
      if (event.action == 0) modifiers_ = 0;
      break;
    default: break;
  }
}

bool Mouse::press(int key, int modifiers) {
  View& view = context_.view;
  if (view.manipulation) {
    if (!view.manipulation->press(key, modifiers)) return modifier_of(key) == 0;
    finish_manipulation();
    return true;
  }
  if (in_polygon() && press_in_polygon(key)) return true;
  if (key == key::escape && stroke_) {
    stroke_.reset();
    left_down_ = false;
    return true;
  }
  return view.choosing && press_while_choosing(key);
}

bool Mouse::press_in_polygon(int key) {
  if (key == key::enter || key == key::pad_enter) {
    end_stroke();
    stroke_.reset();
  } else if (key == key::backspace) {
    stroke_->points.pop_back();
    if (stroke_->points.empty()) stroke_.reset();
  } else if (key == key::escape) {
    stroke_.reset();
  } else {
    return false;
  }
  return true;
}

bool Mouse::press_while_choosing(int key) {
  if (key == key::escape)
    cancel_choosing(context_.session, context_.view);
  else if (key == key::enter || key == key::pad_enter)
    confirm_choosing(context_.view);
  else
    return false;
  return true;
}

bool Mouse::closes_polygon() const {
  return in_polygon() && stroke_->points.size() > 2 && (last_ - stroke_->points.front()).norm() < 2 * slack();
}

void Mouse::add_corner() {
  std::vector<Eigen::Vector2d>& corners = stroke_->points;
  const bool again = now() - last_click_ < double_click_seconds && (last_ - corners.back()).norm() < slack();
  last_click_ = now();
  if (!again && !closes_polygon()) {
    corners.push_back(last_);
    return;
  }
  end_stroke();
  stroke_.reset();
  left_down_ = false;  // letting go is no click
  last_click_ = -1;
}

void Mouse::press_button(const InputEvent& event) {
  View& view = context_.view;
  const auto button = static_cast<MouseButton>(event.code);
  pressed_at_ = last_;
  moved_ = false;
  if (view.manipulation) {
    if (!view.modal) return;
    if (button == MouseButton::Left)
      view.manipulation->confirm();
    else
      view.manipulation->cancel();
    finish_manipulation();
    return;
  }
  if (!context_.session.has_input()) return;
  const bool wanted =
      draws_strokes(view.tool) || view.tool == Tool::Volume || hovered_part() != GizmoPart::None || hovered_handle();
  const NavigationAction action = navigation_action(context_.preferences.navigation, button, modifiers_, !wanted);
  if (action != NavigationAction::None) {
    view.glide.stop();
    navigation_ = action;
    navigating_button_ = button;
    grabbed_ = action == NavigationAction::Orbit ? std::nullopt : point_under(last_);
    if (button == MouseButton::Left) left_down_ = true;
    return;
  }
  if (button == MouseButton::Left) press_left(modifiers_);
}

void Mouse::press_left(int modifiers) {
  View& view = context_.view;
  left_down_ = true;
  if (in_polygon()) {
    add_corner();
    return;
  }
  pressed_handle_ = hovered_handle();
  const GizmoPart part = hovered_part();
  if (part != GizmoPart::None) {
    begin_manipulation(context_.session, view, gizmo()->kind, part, false);
    return;
  }
  if (pressed_handle_) {
    context_.session.choose_handle(pressed_handle_);
    return;
  }
  if (view.choosing || view.tool == Tool::Volume) return;
  Stroke stroke;
  stroke.tool = draws_strokes(view.tool) ? view.tool : Tool::Box;
  stroke.mode = select_mode(modifiers);
  stroke.points = {last_};
  stroke_ = std::move(stroke);
  if (stroke_->tool == Tool::Brush) brush(last_, last_);
  ball_at_.reset();
  if (stroke_->tool == Tool::Ball) paint_ball();
  last_click_ = stroke_->tool == Tool::Polygon ? now() : last_click_;
}

void Mouse::release_button(const InputEvent& event) {
  View& view = context_.view;
  const auto button = static_cast<MouseButton>(event.code);
  if (navigation_ != NavigationAction::None && button == navigating_button_) {
    navigation_ = NavigationAction::None;
    if (button == MouseButton::Left && left_down_ && !moved_) click(modifiers_);
    left_down_ = false;
    return;
  }
  if (button != MouseButton::Left || !left_down_) return;
  left_down_ = false;
  if (in_polygon()) return;
  if (view.manipulation && !view.modal) {
    view.manipulation->confirm();
    finish_manipulation();
    return;
  }
  if (!moved_)
    click(modifiers_);
  else if (stroke_)
    end_stroke();
  stroke_.reset();
  pressed_handle_.reset();
}

void Mouse::move(const InputEvent& event) {
  View& view = context_.view;
  const Eigen::Vector2d at(event.x, event.y), step = at - last_;
  last_ = view.mouse = at;
  if ((at - pressed_at_).norm() > slack()) moved_ = true;
  switch (navigation_) {
    case NavigationAction::Orbit: orbit(view.camera, step, view.size, view.up); return;
    case NavigationAction::Pan: pan(view.camera, step, view.size, grabbed_); return;
    case NavigationAction::Zoom:
      zoom(view.camera, zoom_of_drag(step.y()), pressed_at_, view.size, context_.session.rest_bounds().diagonal(),
           grabbed_);
      return;
    case NavigationAction::None: break;
  }
  if (view.manipulation) {
    update_manipulation(context_.session, view, modifiers_);
    return;
  }
  if (!left_down_ || !moved_ || in_polygon()) return;
  if (pressed_handle_) {
    const GizmoKind kind = view.tool == Tool::Rotate ? GizmoKind::Rotate : GizmoKind::Translate;  // a ball has no size
    view.mouse = pressed_at_;
    begin_manipulation(context_.session, view, kind, GizmoPart::Screen, false);
    view.mouse = at;
    pressed_handle_.reset();
    update_manipulation(context_.session, view, modifiers_);
  } else if (stroke_) {
    if (stroke_->tool == Tool::Brush) brush(at - step, at);
    if (stroke_->tool == Tool::Ball) paint_ball();
    if (stroke_->tool == Tool::Box && stroke_->points.size() == 2) stroke_->points.pop_back();
    stroke_->points.push_back(at);
  }
}

void Mouse::wheel(double steps) {
  View& view = context_.view;
  if (!context_.session.has_input() || steps == 0) return;
  view.glide.stop();
  if (wheel_at_ != last_) {
    wheel_at_ = last_;
    wheel_under_ = point_under(last_);
  }
  zoom(view.camera, zoom_of_wheel(steps), last_, view.size, context_.session.rest_bounds().diagonal(), wheel_under_);
}

void Mouse::click(int modifiers) {
  const bool again = now() - last_click_ < double_click_seconds && (last_ - last_click_at_).norm() < slack();
  last_click_ = again ? -1 : now();
  last_click_at_ = last_;
  if (again) {
    double_click();
    return;
  }
  if (pressed_handle_ || (stroke_ && (stroke_->tool == Tool::Brush || stroke_->tool == Tool::Ball))) return;
  Session& session = context_.session;
  if (context_.view.choosing || context_.view.tool == Tool::Volume) {
    const bool placed = context_.view.tool == Tool::Volume;
    if (const std::optional<Vec3> at = placed ? point_under(last_) : std::nullopt)
      choose_by_volume(session, context_.view, at);
    return;
  }
  const SelectMode mode = select_mode(modifiers);
  PointSet touched(session.input()->size());
  if (const std::optional<Index> point = click_point(screen(), last_, 2 * slack())) {
    touched.add(*point);
    context_.view.clicked = *point;
  }
  if (!touched.empty() || mode == SelectMode::Replace) session.select(touched, mode);
  if (touched.empty()) session.choose_handle({});
}

void Mouse::double_click() {
  View& view = context_.view;
  if (const std::optional<Vec3> pivot = point_under(last_)) glide_to(view, with_pivot(view.camera, *pivot));
}

void Mouse::finish_manipulation() {
  follow_manipulation(context_.session, context_.view);
  if (!context_.view.manipulation) left_down_ = false;
}

void Mouse::end_stroke() {
  Session& session = context_.session;
  const Depth depth = context_.view.depth;
  if (stroke_->tool == Tool::Box && stroke_->points.size() == 2)
    session.select(in_box(screen(), stroke_->points[0], stroke_->points[1], depth), stroke_->mode);
  else if ((stroke_->tool == Tool::Lasso || in_polygon()) && stroke_->points.size() > 2)
    session.select(editor::in_polygon(screen(), stroke_->points, depth), stroke_->mode);
  else if (stroke_->tool == Tool::Cut && stroke_->points.size() > 1)
    cut();
}

/// The stroke as a curtain along the view: as it is drawn where the middle of the shape is, and through all of it.
void Mouse::cut() {
  const View& view = context_.view;
  const Bounds bounds = context_.session.rest_bounds();
  Vec3 middle;
  if (!gpu::project(view.camera, view.size, bounds.centre(), middle)) return;
  const Vec3 depth = bounds.diagonal() * (view.camera.target - view.camera.eye).normalized();
  std::vector<Vec3> path;
  Eigen::Vector2d last = stroke_->points.front();
  for (const Eigen::Vector2d& point : stroke_->points) {
    const bool end = &point == &stroke_->points.front() || &point == &stroke_->points.back();
    if (!end && (point - last).norm() < 2 * slack()) continue;
    path.push_back(gpu::unproject(view.camera, view.size, point, middle.z()) - 0.5 * depth);
    last = point;
  }
  context_.session.add_cut(path, depth);
}

void Mouse::brush(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const double radius = context_.view.brush_radius * static_cast<double>(scale());
  context_.session.select(in_stroke(screen(), from, to, radius, context_.view.depth), stroke_->mode);
  // The first dab replaces what was selected; the rest of the stroke belongs to it.
  if (stroke_->mode == SelectMode::Replace) stroke_->mode = SelectMode::Add;
}

/// From the last place of the surface to the one under the mouse; the first dab replaces as that of brush() does.
void Mouse::paint_ball() {
  Session& session = context_.session;
  const std::optional<Vec3> at = point_under(last_);
  PointSet touched(session.input()->size());
  if (at) {
    const double radius = context_.view.ball_radius;
    const bool near = ball_at_ && (*ball_at_ - *at).norm() < 4 * radius;  // else the mouse left the surface between
    touched = in_capsule(session.bent_positions(), near ? *ball_at_ : *at, *at, radius);
    if (context_.view.depth == Depth::VisibleOnly)
      touched = intersected(touched, screen().visible({{0, 0}, context_.view.size}));
  }
  ball_at_ = at;
  session.select(touched, stroke_->mode);
  if (stroke_->mode == SelectMode::Replace) stroke_->mode = SelectMode::Add;
}

std::optional<Vec3> Mouse::ball() {
  if (context_.view.tool != Tool::Ball || !context_.session.has_input() || navigating() || dragging())
    return std::nullopt;
  return point_under(last_);
}

const ScreenPoints& Mouse::screen() {
  screen_.set_hidden(context_.session.hidden());
  screen_.update(context_.view.camera, context_.view.size, context_.session.bent_positions(),
                 context_.session.bent_version());
  return screen_;
}

std::optional<Vec3> Mouse::point_under(const Eigen::Vector2d& at) {
  const std::optional<Index> point = click_point(screen(), at, 3 * slack());
  if (!point) return std::nullopt;
  return context_.session.bent_positions()[*point];
}

std::vector<Vec3> Mouse::balls() const {
  std::vector<Vec3> out;
  for (const HandleView& handle : context_.session.handles()) out.push_back(handle.target);
  return out;
}

std::optional<Gizmo> Mouse::gizmo() const {
  std::optional<Gizmo> gizmo = gizmo_of(context_.session, context_.view);
  if (!gizmo) return gizmo;
  if (context_.view.manipulation) gizmo->kind = context_.view.manipulation->kind();
  gizmo->length *= static_cast<double>(scale());
  return gizmo;
}

GizmoPart Mouse::hovered_part() const {
  const std::optional<Gizmo> shown = gizmo();
  if (!shown) return GizmoPart::None;
  return hit_gizmo(*shown, context_.view.camera, context_.view.size, last_, 1.5 * slack());
}

std::optional<std::size_t> Mouse::hovered_handle() const {
  return hit_handle(balls(), context_.view.camera, context_.view.size, last_, 2.5 * slack());
}

}  // namespace sinew::editor
