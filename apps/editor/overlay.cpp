#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/editor/gui.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

ImVec2 screen(const Eigen::Vector2d& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y())};
}

ImVec4 color_of(GizmoPart part) {
  switch (part) {
    case GizmoPart::X:
    case GizmoPart::PlaneX: return theme().axes[0];
    case GizmoPart::Y:
    case GizmoPart::PlaneY: return theme().axes[1];
    case GizmoPart::Z:
    case GizmoPart::PlaneZ: return theme().axes[2];
    default: return theme().text;
  }
}

ImVec4 brighter(const ImVec4& color) {
  const auto mix = [](float c) { return c + 0.45f * (1 - c); };
  return {mix(color.x), mix(color.y), mix(color.z), color.w};
}

void arrow_head(ImDrawList* list, ImVec2 from, ImVec2 tip, ImU32 color) {
  const float length = std::hypot(tip.x - from.x, tip.y - from.y);
  if (length < 1) return;
  const ImVec2 along{(tip.x - from.x) / length, (tip.y - from.y) / length};
  const float size = px(11), half = px(4.5f);
  const ImVec2 base{tip.x - along.x * size * 0.2f, tip.y - along.y * size * 0.2f};
  list->AddTriangleFilled({base.x + along.x * size, base.y + along.y * size},
                          {base.x - along.y * half, base.y + along.x * half},
                          {base.x + along.y * half, base.y - along.x * half}, color);
}

void draw_gizmo(Ui& ui, ImDrawList* list) {
  const std::optional<Gizmo> gizmo = ui.mouse.gizmo();
  if (!gizmo) return;
  const View& view = ui.context.view;
  const std::optional<Manipulation>& held = view.manipulation;
  const GizmoPart lit = held ? held->part() : ui.mouse.hovered_part();
  for (const GizmoStroke& stroke : gizmo_strokes(*gizmo, view.camera, view.size)) {
    if (held && stroke.part != lit) continue;
    ImVec4 color = color_of(stroke.part);
    if (stroke.part == lit) color = brighter(color);
    color.w *= static_cast<float>(stroke.fade);
    std::vector<ImVec2> points;
    for (const Eigen::Vector2d& point : stroke.points) points.push_back(screen(point));
    const int count = static_cast<int>(points.size());
    if (count < 2) continue;
    if (stroke.filled) list->AddConvexPolyFilled(points.data(), count, packed(color, 0.35f));
    const float width = stroke.filled ? 1 : stroke.part == lit ? 3 : 2;
    list->AddPolyline(points.data(), count, packed(color), stroke.closed ? ImDrawFlags_Closed : 0, width * scale());
    if (gizmo->kind == GizmoKind::Translate && !stroke.closed && !stroke.filled)
      arrow_head(list, points[points.size() - 2], points.back(), packed(color));
    if (gizmo->kind == GizmoKind::Scale && !stroke.closed) {
      const ImVec2 tip = points.back();
      list->AddRectFilled({tip.x - px(5), tip.y - px(5)}, {tip.x + px(5), tip.y + px(5)}, packed(color), px(1));
    }
  }
}

/// Text on a dark label, kept within the picture.
void draw_label(Ui& ui, ImDrawList* list, ImVec2 at, const std::string& text) {
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  const float pad = px(8), height = px(22);
  at.x = std::clamp(at.x, px(8), std::max(px(8), ui.layout.column - size.x - 2 * pad - px(8)));
  at.y = std::clamp(at.y, ui.layout.top + px(8), ui.layout.bottom - height - px(8));
  at = {std::round(at.x), std::round(at.y)};
  list->AddRectFilled(at, {at.x + size.x + 2 * pad, at.y + height}, packed(theme().field, 0.92f), px(4));
  widget::text_at(list, ImGui::GetFont(), {at.x + pad, at.y + 0.5f * (height - size.y)}, theme().text, text);
}

/// The line of an axis it is held to, and the measure beside the cursor.
void draw_manipulation(Ui& ui, ImDrawList* list) {
  const View& view = ui.context.view;
  if (!view.manipulation) return;
  const Vec3 axis = view.manipulation->axis();
  const std::optional<Gizmo> gizmo = ui.mouse.gizmo();
  if (gizmo && axis.norm() > 0) {
    const double reach = 40 * gpu::pixel_size(view.camera, view.size.y(), gizmo->centre) * gizmo->length;
    std::vector<ImVec2> ends;
    for (int step = -64; step <= 64; ++step) {
      Eigen::Vector3d at;
      if (gpu::project(view.camera, view.size, gizmo->centre + axis * (reach * step / 64), at))
        ends.push_back({static_cast<float>(at.x()), static_cast<float>(at.y())});
    }
    if (ends.size() > 1)
      list->AddPolyline(ends.data(), static_cast<int>(ends.size()), packed(color_of(view.manipulation->part()), 0.5f),
                        0, scale());
  }
  const ImVec2 mouse = screen(view.mouse);
  draw_label(ui, list, {mouse.x + px(16), mouse.y - px(32)},
             (view.manipulation->kind() == GizmoKind::Translate ? "Δ " : "") + view.manipulation->text());
}

void draw_stroke(Ui& ui, ImDrawList* list) {
  const std::optional<Mouse::Stroke>& stroke = ui.mouse.stroke();
  const bool drawn = stroke && (stroke->tool == Tool::Box || stroke->tool == Tool::Lasso || stroke->tool == Tool::Cut);
  if (!drawn || stroke->points.size() < 2) return;
  const ImU32 line = packed(theme().accent), fill = packed(theme().accent, 0.12f);
  if (stroke->tool == Tool::Box) {
    const ImVec2 a = screen(stroke->points[0]), b = screen(stroke->points[1]);
    const ImVec2 min{std::min(a.x, b.x), std::min(a.y, b.y)}, max{std::max(a.x, b.x), std::max(a.y, b.y)};
    list->AddRectFilled(min, max, fill);
    list->AddRect(min, max, line, 0, 0, scale());
    return;
  }
  std::vector<ImVec2> points;
  for (const Eigen::Vector2d& point : stroke->points) points.push_back(screen(point));
  list->AddPolyline(points.data(), static_cast<int>(points.size()), line, 0, 1.5f * scale());
  if (stroke->tool == Tool::Cut) return;
  list->AddLine(points.back(), points.front(), packed(theme().accent, 0.5f), scale());
}

void draw_brush(Ui& ui, ImDrawList* list) {
  const View& view = ui.context.view;
  if (view.tool != Tool::Brush || !ui.context.session.has_input() || ui.mouse.navigating() || ui.mouse.dragging())
    return;
  if (!ui.mouse.stroking() && ImGui::GetIO().WantCaptureMouse) return;
  const float radius = static_cast<float>(view.brush_radius) * scale();
  list->AddCircle(screen(view.mouse), radius, packed({0, 0, 0, 0.5f}), 64, 3 * scale());
  list->AddCircle(screen(view.mouse), radius, packed({1, 1, 1, 0.9f}), 64, 1.25f * scale());
}

/// Where one axis of the small cross at the corner ends, and how near to the eye.
struct AxisEnd {
  int axis;
  ImVec2 at;
  double depth;
  bool positive;
};

}  // namespace

void show_axes(Ui& ui);

void show_overlay(Ui& ui) {
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  list->PushClipRect({0, ui.layout.top}, {ui.layout.column, ui.layout.bottom});
  draw_gizmo(ui, list);
  draw_manipulation(ui, list);
  draw_stroke(ui, list);
  draw_brush(ui, list);
  draw_selecting(ui, list);
  list->PopClipRect();
  const ImVec4 panel = choosing_panel(ui);  // that may need their room
  // In a narrow window they would stand on the tools.
  const bool room = ui.layout.column > px(80 + 12 + 120) && !(panel.z > 0 && panel.y < ui.layout.top + px(88));
  if (ui.context.session.has_input() && room) show_axes(ui);
}

void show_axes(Ui& ui) {
  View& view = ui.context.view;
  const float side = px(80), radius = px(29), ball = px(8.5f);
  const ImVec2 corner{ui.layout.column - side - px(12), ui.layout.top + px(8)};
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));  // a panel's clip leaves half of it out
  widget::begin_panel("axes", corner, {side, side}, ImGuiWindowFlags_NoBackground);
  ImGui::PopStyleVar();
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 centre{corner.x + 0.5f * side, corner.y + 0.5f * side};
  const Mat3 R = gpu::view_matrix(view.camera).topLeftCorner<3, 3>();
  std::vector<AxisEnd> ends;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {1.0, -1.0}) {
      const Vec3 d = R.col(axis) * sign;
      ends.push_back({axis,
                      {centre.x + radius * static_cast<float>(d.x()), centre.y - radius * static_cast<float>(d.y())},
                      d.z(),
                      sign > 0});
    }
  }
  std::sort(ends.begin(), ends.end(), [](const AxisEnd& a, const AxisEnd& b) { return a.depth < b.depth; });
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const AxisEnd* hovered = nullptr;
  for (const AxisEnd& end : ends)
    if (std::hypot(mouse.x - end.at.x, mouse.y - end.at.y) < ball + px(2) && ImGui::IsWindowHovered()) hovered = &end;
  const char* letters[] = {"X", "Y", "Z"};
  for (const AxisEnd& end : ends) {
    const ImVec4 color = &end == hovered ? brighter(theme().axes[end.axis]) : theme().axes[end.axis];
    if (!end.positive) {
      list->AddCircleFilled(end.at, px(5), packed(color, &end == hovered ? 0.9f : 0.3f), 20);
      continue;
    }
    list->AddLine(centre, end.at, packed(color), 2 * scale());
    list->AddCircleFilled(end.at, ball, packed(color), 24);
    const ImVec2 size = widget::size_of(fonts().small, letters[end.axis]);
    widget::text_at(list, fonts().small, {end.at.x - 0.5f * size.x, end.at.y - 0.5f * size.y}, {0.08f, 0.09f, 0.1f, 1},
                    letters[end.axis]);
  }
  if (hovered != nullptr) {
    const bool y_up = view.up == gpu::UpAxis::Y;
    const char* names[3][2] = {{"right", "left"},
                               {y_up ? "top" : "back", y_up ? "bottom" : "front"},
                               {y_up ? "front" : "top", y_up ? "back" : "bottom"}};
    const char* name = names[hovered->axis][hovered->positive ? 0 : 1];
    widget::tooltip(std::string("Look from the ") + name);
    if (ImGui::IsMouseClicked(0)) glide_to(view, viewed(view.camera, name, view.up));
  }
  ImGui::End();
}

}  // namespace sinew::editor
