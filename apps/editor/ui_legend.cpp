#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/editor/gui.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

using document::FieldKind;
using document::ValueRange;

/// "displacement" as "Displacement".
std::string title_of(std::string name) {
  if (!name.empty()) name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

constexpr const char* heat_help =
    "An attribute of the points, or what the edit does to them: how far they went (in the file's unit), how much "
    "longer "
    "or shorter the material is (%), how far it is turned (degrees), where the layer's structure is strained, and how "
    "much the chosen handle, or the point clicked last, has to say";

/// Where the bar of colours is, pixels.
struct Bar {
  ImVec2 min, max;
  ValueRange domain;

  float y(double value) const { return max.y - static_cast<float>(place_of(domain, value)) * (max.y - min.y); }
  double place(float at) const { return static_cast<double>((max.y - at) / std::max(1.0f, max.y - min.y)); }
};

ImU32 solid(const gpu::PointColor& c) {
  return IM_COL32(c.r, c.g, c.b, 255);
}

/// The colours between the ends of the range, and beyond them those of the ends.
void draw_bar(ImDrawList* list, const Bar& bar, const ValueRange& range, gpu::Colormap map) {
  const float low = bar.y(range.low), high = bar.y(range.high);
  list->AddRectFilled({bar.min.x, bar.min.y}, {bar.max.x, high}, solid(gpu::color_at(map, 1)));
  list->AddRectFilled({bar.min.x, low}, {bar.max.x, bar.max.y}, solid(gpu::color_at(map, 0)));
  constexpr int steps = 48;
  for (int i = 0; i < steps; ++i) {
    const auto y = [&](int step) { return low + (high - low) * static_cast<float>(step) / steps; };
    const ImU32 below = solid(gpu::color_at(map, static_cast<double>(i) / steps)),
                above = solid(gpu::color_at(map, static_cast<double>(i + 1) / steps));
    list->AddRectFilledMultiColor({bar.min.x, y(i + 1)}, {bar.max.x, y(i)}, above, above, below, below);
  }
  list->AddRect(bar.min, bar.max, packed(theme().line));
}

/// Numbers at the right; those that the ends of the range stand over are left out.
void draw_ticks(ImDrawList* list, const Bar& bar, const ValueRange& range) {
  const float size = fonts().text->FontSize;
  const Ticks ticks = ticks_of(bar.domain, std::max(2, static_cast<int>((bar.max.y - bar.min.y) / px(28))));
  for (const double value : ticks.values) {
    const float y = std::round(bar.y(value));
    list->AddLine({bar.max.x, y}, {bar.max.x + px(4), y}, packed(theme().quiet), px(1));
    if (std::min(std::abs(y - bar.y(range.low)), std::abs(y - bar.y(range.high))) < 0.9f * size) continue;
    widget::text_at(list, fonts().text, {bar.max.x + px(8), y - 0.5f * size}, theme().quiet,
                    tick_text(value, ticks.step));
  }
}

/// A line across the bar with a grip at its left, and its number.
void draw_end(ImDrawList* list, const Bar& bar, double value, bool held) {
  const float y = std::round(bar.y(value)), grip = px(5), size = fonts().bold->FontSize;
  const ImU32 color = packed(held ? theme().accent : theme().text);
  list->AddLine({bar.min.x - px(2), y}, {bar.max.x + px(4), y}, color, px(2));
  list->AddTriangleFilled({bar.min.x - px(2), y}, {bar.min.x - px(2) - grip, y - grip},
                          {bar.min.x - px(2) - grip, y + grip}, color);
  const double span = bar.domain.high - bar.domain.low;
  widget::text_at(list, fonts().bold, {bar.max.x + px(8), y - 0.5f * size}, theme().text,
                  tick_text(value, std::pow(10, std::floor(std::log10(span)) - 1)));
}

void drag(Ui& ui, const Bar& bar, const Coloring& coloring) {
  View& view = ui.context.view;
  ImGui::SetCursorScreenPos({bar.min.x - px(12), bar.min.y - px(8)});
  ImGui::InvisibleButton("bar", {bar.max.x - bar.min.x + px(72), bar.max.y - bar.min.y + px(16)});
  const float mouse = ImGui::GetIO().MousePos.y;
  const double reach = static_cast<double>(px(8) / std::max(1.0f, bar.max.y - bar.min.y));
  if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(0)) {
    view.color_range.reset();
    ui.legend.part = LegendPart::None;
    return;
  }
  if (ImGui::IsItemActivated())
    ui.legend = {legend_part(bar.domain, coloring.range, bar.place(mouse), reach), bar.domain, coloring.range, mouse};
  if (ImGui::IsItemActive() && ui.legend.part != LegendPart::None && ImGui::IsMouseDragging(0, px(2))) {
    const bool around = coloring.map == gpu::Colormap::CoolWarm && coloring.usual.low == -coloring.usual.high;
    view.color_range = dragged(ui.legend.before, ui.legend.part, bar.place(mouse) - bar.place(ui.legend.from),
                               ui.legend.domain, around);
  }
  if (!ImGui::IsItemActive()) ui.legend.part = LegendPart::None;
  if (!ImGui::IsItemHovered()) return;
  ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeNS);
  if (!ImGui::IsItemActive()) widget::tooltip("Drag the ends of the range; a double click sets it back");
}

}  // namespace

float legend_left(const Ui& ui) {
  const View& view = ui.context.view;
  const bool colored = ui.stage.coloring().field && (!view.color_by.empty() || view.heat);
  const bool room = ui.layout.column >= px(112 + 120);  // beside the tools
  const bool shown = ui.context.session.has_input() && colored && room;
  return ui.layout.column - (shown ? px(112 + 12) : 0);
}

void show_legend(Ui& ui) {
  if (legend_left(ui) == ui.layout.column) return;
  const Coloring& coloring = ui.stage.coloring();
  const View& view = ui.context.view;
  const float width = px(112), top = ui.layout.top + px(96);
  const float room = ui.layout.bottom - top - px(96);
  const float height = std::clamp(room, px(72), px(196));
  const ImVec2 at{legend_left(ui), top};
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(6));
  widget::begin_panel("legend", at, {width, height});
  ImDrawList* list = ImGui::GetWindowDrawList();
  const document::Field& field = *coloring.field;
  const std::string unit = field.unit.empty() ? "" : ", " + field.unit.substr(field.unit[0] == ' ' ? 1 : 0);
  widget::text_at(list, fonts().text, {at.x + px(12), at.y + px(8)}, theme().text,
                  widget::cut(title_of(field.name) + unit, width - px(24)));
  Bar bar;
  bar.min = {at.x + px(20), at.y + px(36)};
  bar.max = {at.x + px(36), at.y + height - px(16)};
  bar.domain = ui.legend.part == LegendPart::None ? legend_domain(coloring.range, coloring.usual, coloring.extent)
                                                  : ui.legend.domain;
  drag(ui, bar, coloring);
  const ValueRange& range = view.color_range ? *view.color_range : coloring.range;
  draw_bar(list, bar, range, coloring.map);
  draw_ticks(list, bar, range);
  const LegendPart held = ui.legend.part;
  draw_end(list, bar, range.low, held == LegendPart::Low || held == LegendPart::Both);
  draw_end(list, bar, range.high, held == LegendPart::High || held == LegendPart::Both);
  ImGui::End();
  ImGui::PopStyleVar();
}

void show_coloring(Ui& ui) {
  View& view = ui.context.view;
  const Session& session = ui.context.session;
  const std::vector<std::string> attributes = color_choices(*session.input());
  std::vector<std::string> names{"Plain"};
  names.insert(names.end(), attributes.begin(), attributes.end());
  if (session.layer() != nullptr)
    for (const char* name : document::field_names) names.push_back(title_of(name));
  if (names.size() == 1) return;
  std::size_t chosen = 0;
  for (std::size_t i = 0; i < attributes.size(); ++i)
    if (attributes[i] == view.color_by) chosen = i + 1;
  if (view.heat && session.layer() != nullptr) chosen = attributes.size() + 1 + static_cast<std::size_t>(*view.heat);
  widget::label("Colour by", heat_help);
  if (widget::choice("##color", chosen, names)) {
    view.color_range.reset();
    view.heat.reset();
    view.color_by = chosen == 0 || chosen > attributes.size() ? "" : attributes[chosen - 1];
    if (chosen > attributes.size()) view.heat = static_cast<FieldKind>(chosen - attributes.size() - 1);
  }
  if (view.heat && session.layer() == nullptr) view.heat.reset();
  const Coloring& coloring = ui.stage.coloring();
  if (coloring.field && (view.heat || !view.color_by.empty())) {
    const std::vector<std::string> maps{"Viridis", "Turbo", "Cool-warm"};
    auto map = static_cast<std::size_t>(coloring.map);
    widget::label("Colours", "Viridis reads best; turbo tells more steps apart; cool-warm has 0 in its middle");
    if (widget::choice("##map", map, maps)) {
      view.colormap = static_cast<gpu::Colormap>(map);
      view.color_range.reset();
    }
  }
  if (view.heat == FieldKind::Influence && !influencing_map(session, view)) {
    ImGui::PushStyleColor(ImGuiCol_Text, theme().quiet);
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Click a point, or choose a handle");
    ImGui::PopStyleColor();
  }
}

}  // namespace sinew::editor
