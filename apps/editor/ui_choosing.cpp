#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/editor/gui.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

constexpr float panel_width = 272, histogram_height = 72, button_width = 96;

/// So many digits that a thousandth of `range` is seen in numbers as large as `largest`.
int digits_for(double largest, double range) {
  if (!(largest > 0) || !(range > 0)) return 4;
  return std::clamp(4 + static_cast<int>(std::ceil(std::log10(largest / range))), 4, 15);
}

/// A number that counts while it is dragged; true when it changed.
bool live(const char* name, const char* help, const widget::Number& described, double& value) {
  widget::label(name, help);
  ImGui::PushID(name);
  const double before = value;
  widget::number("##value", value, described);
  ImGui::PopID();
  return value != before;
}

bool show_volume(Ui& ui, Choosing& choosing) {
  Volume& volume = *choosing.volume();
  const Session& session = ui.context.session;
  const Vec3 origin = session.input()->origin;
  const double diagonal = session.rest_bounds().diagonal();
  constexpr std::array kinds{"Box", "Sphere"};
  bool changed = false;
  const int kind = widget::switch_of("kind", kinds, volume.kind == Volume::Kind::Box ? 0 : 1, {});
  ImGui::SameLine(0, px(16));
  constexpr std::array gizmos{"Move", "Size"};
  constexpr std::array gizmo_help{"The arrows move it (G)", "The axes size it (S)"};
  if (const int gizmo = widget::switch_of("gizmo", gizmos, choosing.sizing ? 1 : 0, gizmo_help); gizmo >= 0)
    choosing.sizing = gizmo == 1;
  if (kind >= 0) {
    volume = with_kind(volume, kind == 0 ? Volume::Kind::Box : Volume::Kind::Sphere);
    changed = true;
  }
  constexpr std::array centres{"Centre X", "Centre Y", "Centre Z"}, sizes{"Size X", "Size Y", "Size Z"};
  widget::Number number{-1e12, 1e12, false, false, ""};
  number.speed = 1e-3 * diagonal;
  number.digits = digits_for(origin.cwiseAbs().maxCoeff() + diagonal, diagonal);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    double at = volume.centre[axis] + origin[axis];
    if (live(centres[static_cast<std::size_t>(axis)], "In the file's coordinates", number, at)) {
      volume.centre[axis] = at - origin[axis];
      changed = true;
    }
  }
  number.digits = 4;
  number.min = 1e-6 * diagonal;
  if (volume.kind == Volume::Kind::Sphere) {
    double radius = volume.half.x();
    if (live("Radius", "In the shape's unit", number, radius)) {
      volume.half.setConstant(radius);
      changed = true;
    }
    return changed;
  }
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    double size = 2 * volume.half[axis];
    if (live(sizes[static_cast<std::size_t>(axis)], "In the shape's unit", number, size)) {
      volume.half[axis] = 0.5 * size;
      changed = true;
    }
  }
  return changed;
}

/// Which end of the range the mouse drags: 0 none, 1 low, 2 high.
int& dragged_end() {
  return *ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("dragged end"), 0);
}

bool drag_range(AttributeRange& range, float left, float width) {
  if (!ImGui::IsItemActive() || !(range.most > range.least)) {
    dragged_end() = 0;
    return false;
  }
  const double span = range.most - range.least;
  const double part = std::clamp((ImGui::GetIO().MousePos.x - left) / width, 0.0f, 1.0f);
  const double value = range.least + part * span;
  if (dragged_end() == 0) dragged_end() = std::abs(value - range.low) <= std::abs(value - range.high) ? 1 : 2;
  double& end = dragged_end() == 1 ? range.low : range.high;
  const double wanted = dragged_end() == 1 ? std::min(value, range.high) : std::max(value, range.low);
  const bool changed = wanted != end;
  end = wanted;
  return changed;
}

/// Bars as high as the root of how many points they stand for, so that few are seen beside many; the range bright, with
/// an edge to drag at each end.
bool show_histogram(AttributeRange& range) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = px(histogram_height);
  ImGui::InvisibleButton("histogram", {width, height});
  const bool changed = drag_range(range, at.x, width);
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(at, {at.x + width, at.y + height}, packed(theme().field), px(3));
  const std::uint32_t most = *std::max_element(range.bins.begin(), range.bins.end());
  const double span = range.most - range.least;
  const auto x_of = [&](double value) {
    const double part = span > 0 ? (value - range.least) / span : value <= range.least ? 0 : 1;
    return at.x + std::round(static_cast<float>(part) * width);
  };
  const float low = x_of(range.low), high = span > 0 ? x_of(range.high) : at.x + width;
  const auto count = static_cast<float>(range.bins.size());
  for (std::size_t b = 0; b < range.bins.size() && most > 0; ++b) {
    if (range.bins[b] == 0) continue;
    const float x0 = at.x + width * static_cast<float>(b) / count,
                x1 = at.x + width * static_cast<float>(b + 1) / count;
    const float part = std::sqrt(static_cast<float>(range.bins[b]) / static_cast<float>(most));
    const float top = at.y + height - std::max(px(1), part * (height - px(4)));
    const bool in = x1 > low && x0 < high;
    list->AddRectFilled({x0, top}, {x1, at.y + height},
                        packed(in ? theme().accent : theme().quiet, in ? 0.85f : 0.35f));
  }
  for (const float x : {low, high - px(2)})
    list->AddRectFilled({x, at.y}, {x + px(2), at.y + height}, packed(theme().text));
  list->AddRect(at, {at.x + width, at.y + height}, packed(theme().line), px(3), 0, px(1));
  return changed;
}

bool show_range(Ui& ui, AttributeRange& range) {
  ImGui::PushFont(fonts().bold);
  ImGui::TextUnformatted("Select by attribute");
  ImGui::PopFont();
  const std::vector<std::string> names = range_choices(*ui.context.session.input());
  auto chosen = static_cast<std::size_t>(std::find(names.begin(), names.end(), range.name) - names.begin());
  widget::label("Attribute", "x, y and z are those of the file, at rest");
  if (widget::choice("##attribute", chosen, names)) {
    choose_by_attribute(ui.context.session, ui.context.view, names[chosen]);
    return false;
  }
  bool changed = show_histogram(range);
  const std::string unit = unit_of(range.name);
  widget::Number number{range.least, range.most, false, false, unit.c_str()};
  number.speed = (range.most - range.least) / 400;
  number.digits = digits_for(std::max(std::abs(range.least), std::abs(range.most)), range.most - range.least);
  changed |= live("From", "The least number that is selected", number, range.low);
  changed |= live("To", "The largest number that is selected", number, range.high);
  if (changed && range.low > range.high) std::swap(range.low, range.high);
  return changed;
}

}  // namespace

ImVec4 choosing_panel(const Ui& ui) {
  const View& view = ui.context.view;
  if (!view.choosing || !ui.context.session.has_input()) return {0, 0, 0, 0};
  const Volume* volume = view.choosing->volume();
  const float rows = volume == nullptr ? 3 : volume->kind == Volume::Kind::Box ? 7 : 5;
  const float height = px(measure::row) * (rows + 2) + px(volume == nullptr ? histogram_height + 96 : 72);
  // Below the axes where there is room.
  const float lowest = std::max(ui.layout.top + px(8), ui.layout.bottom - height - px(8));
  const float right = ui.layout.column - px(measure::edge), left = std::max(right - px(panel_width), tools_right(ui));
  return {left, std::min(ui.layout.top + px(96), lowest), right - left, height};
}

void show_choosing(Ui& ui) {
  const ImVec4 panel = choosing_panel(ui);
  if (!(panel.z > 0)) return;
  View& view = ui.context.view;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(6));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(measure::pad), px(measure::pad)));
  widget::push_fields();
  widget::begin_panel("choosing", {panel.x, panel.y}, {panel.z, panel.w});
  bool changed =
      view.choosing->volume() != nullptr ? show_volume(ui, *view.choosing) : show_range(ui, *view.choosing->range());
  Choosing& choosing = *view.choosing;
  ImGui::Dummy({0, px(4)});
  constexpr std::array modes{"Replace", "Add", "Remove"};
  constexpr std::array help{"These points and no others", "These points and those selected before",
                            "Those selected before without these"};
  if (const int mode = widget::switch_of("mode", modes, static_cast<int>(choosing.mode), help); mode >= 0) {
    choosing.mode = static_cast<SelectMode>(mode);
    changed = true;
  }
  ImGui::Dummy({0, px(4)});
  const std::size_t selected = ui.context.session.selection().count();
  widget::text_cut(grouped(selected) + (selected == 1 ? " point selected" : " points selected"),
                   ImGui::GetContentRegionAvail().x, theme().quiet);
  ImGui::Dummy({0, px(4)});
  const bool done = widget::button("Done", true, px(button_width));
  ImGui::SameLine(0, px(8));
  const bool cancel = widget::button("Cancel", false, px(button_width));
  ImGui::End();
  widget::pop_fields();
  ImGui::PopStyleVar(2);
  if (changed) apply_choosing(ui.context.session, view);
  if (done) confirm_choosing(view);
  if (cancel) cancel_choosing(ui.context.session, view);
}

}  // namespace sinew::editor
