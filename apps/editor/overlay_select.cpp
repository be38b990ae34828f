#include <imgui.h>

#include <Eigen/Geometry>

#include <cmath>
#include <numbers>

#include "apps/editor/theme.h"
#include "apps/editor/ui.h"

namespace sinew::editor {

namespace {

ImVec2 screen(const Eigen::Vector2d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y())};
}

/// A line through points of space; what is behind the eye is left out.
void draw_line(const View& view, ImDrawList* list, std::span<const Vec3> points, ImU32 color, float width) {
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    Vec3 a, b;
    if (!gpu::project(view.camera, view.size, points[i], a) || !gpu::project(view.camera, view.size, points[i + 1], b))
      continue;
    list->AddLine(screen(a.head<2>()), screen(b.head<2>()), color, width);
  }
}

void draw_polygon(Ui& ui, ImDrawList* list) {
  if (!ui.mouse.in_polygon()) return;
  std::vector<ImVec2> points;
  for (const Eigen::Vector2d& corner : ui.mouse.stroke()->points) points.push_back(screen(corner));
  const std::size_t corners = points.size();
  const bool closes = ui.mouse.closes_polygon();
  points.push_back(closes ? points.front() : screen(ui.context.view.mouse));
  list->AddPolyline(points.data(), static_cast<int>(points.size()), packed(theme().accent), 0, 1.5f * scale());
  if (corners > 1) list->AddLine(points.back(), points.front(), packed(theme().accent, 0.5f), scale());
  for (std::size_t i = 0; i < corners; ++i) {
    const float radius = px(i == 0 && closes ? 6 : 4);
    list->AddCircleFilled(points[i], radius, packed(theme().field), 20);
    list->AddCircle(points[i], radius, packed(theme().accent), 20, 1.5f * scale());
  }
}

/// A ring of the ball's own size around the surface under the mouse; beside the shape a small cross.
void draw_ball(Ui& ui, ImDrawList* list) {
  const View& view = ui.context.view;
  if (view.tool != Tool::Ball || !ui.context.session.has_input() || ui.mouse.navigating() || ui.mouse.dragging())
    return;
  if (!ui.mouse.stroking() && ImGui::GetIO().WantCaptureMouse) return;
  const ImU32 dark = packed({0, 0, 0, 0.5f}), bright = packed({1, 1, 1, 0.9f});
  Vec3 middle;
  const std::optional<Vec3> at = ui.mouse.ball();
  if (!at || !gpu::project(view.camera, view.size, *at, middle)) {
    const ImVec2 mouse = screen(view.mouse);
    const float arm = px(5);
    list->AddLine({mouse.x - arm, mouse.y}, {mouse.x + arm, mouse.y}, bright, scale());
    list->AddLine({mouse.x, mouse.y - arm}, {mouse.x, mouse.y + arm}, bright, scale());
    return;
  }
  const double pixel = gpu::pixel_size(view.camera, view.size.y(), *at);
  const auto radius = static_cast<float>(view.ball_radius / pixel);
  const ImVec2 centre = screen(middle.head<2>());
  list->AddCircle(centre, radius, dark, 64, 3 * scale());
  list->AddCircle(centre, radius, bright, 64, 1.25f * scale());
  list->AddCircleFilled(centre, px(2), bright, 12);
}

/// Corner k of a box; bits of k: x, y, z.
Vec3 corner_of(const Volume& volume, int k) {
  return volume.centre +
         volume.half.cwiseProduct(Vec3((k & 1) != 0 ? 1 : -1, (k & 2) != 0 ? 1 : -1, (k & 4) != 0 ? 1 : -1));
}

void draw_box(const View& view, ImDrawList* list, const Volume& volume, ImU32 color) {
  for (int k = 0; k < 8; ++k)
    for (const int axis : {1, 2, 4})
      if ((k & axis) == 0)
        draw_line(view, list, std::array{corner_of(volume, k), corner_of(volume, k | axis)}, color, 1.5f * scale());
}

void draw_circle(const View& view, ImDrawList* list, const Volume& volume, const Vec3& normal, ImU32 color) {
  constexpr int segments = 96;
  const Vec3 first = volume.half.x() * normal.unitOrthogonal(), second = normal.cross(first);
  std::vector<Vec3> points;
  for (int i = 0; i <= segments; ++i) {
    const double angle = 2 * std::numbers::pi * i / segments;
    points.push_back(volume.centre + std::cos(angle) * first + std::sin(angle) * second);
  }
  draw_line(view, list, points, color, 1.5f * scale());
}

void draw_volume(const Ui& ui, ImDrawList* list) {
  const View& view = ui.context.view;
  const Volume* volume = view.choosing ? view.choosing->volume() : nullptr;
  if (volume == nullptr) return;
  const ImU32 color = packed(theme().accent), faint = packed(theme().accent, 0.45f);
  if (volume->kind == Volume::Kind::Box) {
    draw_box(view, list, *volume, color);
    return;
  }
  for (int axis = 0; axis < 3; ++axis) draw_circle(view, list, *volume, Vec3::Unit(axis), faint);
  const Vec3 eye =
      view.camera.orthographic ? Vec3(view.camera.eye - view.camera.target) : Vec3(view.camera.eye - volume->centre);
  draw_circle(view, list, *volume, eye.normalized(), color);
}

}  // namespace

void draw_selecting(Ui& ui, ImDrawList* list) {
  draw_volume(ui, list);
  draw_polygon(ui, list);
  draw_ball(ui, list);
}

}  // namespace sinew::editor
