#include <imgui.h>

#include <array>
#include <cmath>

#include "apps/editor/icons.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

/// A button of the tool bar; "" is a gap with a line.
struct ToolRow {
  const char* command;
  const char* icon;
  enum class Tint { Plain, Fixed, Handle, Rigid, Stiffer, Softer } tint = Tint::Plain;
  int tool = -1;  ///< of enum Tool; -1: a command that is done at once
};

constexpr std::array<ToolRow, 19> rows{
    {{"tool.select", icon::pointer, ToolRow::Tint::Plain, static_cast<int>(Tool::Select)},
     {"tool.move", icon::move, ToolRow::Tint::Plain, static_cast<int>(Tool::Move)},
     {"tool.rotate", icon::rotate, ToolRow::Tint::Plain, static_cast<int>(Tool::Rotate)},
     {"tool.scale", icon::scale, ToolRow::Tint::Plain, static_cast<int>(Tool::Scale)},
     {"", ""},
     {"tool.box", icon::box, ToolRow::Tint::Plain, static_cast<int>(Tool::Box)},
     {"tool.lasso", icon::lasso, ToolRow::Tint::Plain, static_cast<int>(Tool::Lasso)},
     {"tool.polygon", icon::polygon, ToolRow::Tint::Plain, static_cast<int>(Tool::Polygon)},
     {"tool.brush", icon::brush, ToolRow::Tint::Plain, static_cast<int>(Tool::Brush)},
     {"tool.ball", icon::sphere, ToolRow::Tint::Plain, static_cast<int>(Tool::Ball)},
     {"tool.volume", icon::volume, ToolRow::Tint::Plain, static_cast<int>(Tool::Volume)},
     {"tool.cut", icon::cut, ToolRow::Tint::Plain, static_cast<int>(Tool::Cut)},
     {"", ""},
     {"mark.fixed", icon::fixed, ToolRow::Tint::Fixed},
     {"mark.handle", icon::handle, ToolRow::Tint::Handle},
     {"mark.rigid", icon::rigid, ToolRow::Tint::Rigid},
     {"mark.stiffer", icon::stiffer, ToolRow::Tint::Stiffer},
     {"mark.softer", icon::softer, ToolRow::Tint::Softer},
     {"mark.free", icon::free}}};

ImVec4 color_of(ToolRow::Tint tint) {
  switch (tint) {
    case ToolRow::Tint::Fixed: return theme().fixed;
    case ToolRow::Tint::Handle: return theme().handle;
    case ToolRow::Tint::Rigid: return theme().rigid;
    case ToolRow::Tint::Stiffer: return stiffness_tint(4);
    case ToolRow::Tint::Softer: return stiffness_tint(0.25);
    case ToolRow::Tint::Plain: break;
  }
  return theme().quiet;
}

void panel_style() {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(6));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(5), px(5)));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(2), px(2)));
}

/// Of the bar with so many buttons a line.
float bar_height(float side, int columns) {
  float height = 2 * px(5) - px(2);
  int in_line = 0;
  for (const ToolRow& row : rows) {
    const bool line = row.command[0] == 0;
    if (line) height += px(9);
    if (!line && in_line == 0) height += side + px(2);
    in_line = line ? 0 : (in_line + 1) % columns;
  }
  return height;
}

/// As few as the window's height allows.
int columns_of(const Ui& ui) {
  const float room = ui.layout.bottom - ui.layout.top - 2 * px(measure::edge);
  int columns = 1;
  while (columns < 4 && bar_height(px(measure::tool_button), columns) > room) ++columns;
  return columns;
}

float bar_width(int columns) {
  const auto count = static_cast<float>(columns);
  return columns == 1 ? px(measure::tool_column) : count * px(measure::tool_button) + (count - 1) * px(2) + 2 * px(5);
}

void show_bar(Ui& ui) {
  const float side = px(measure::tool_button), left = px(measure::edge);
  const float top = ui.layout.top + px(measure::edge);
  const int columns = columns_of(ui);
  const float width = bar_width(columns), height = bar_height(side, columns);
  panel_style();
  widget::begin_panel("tools", {left, top}, {width, height});
  int in_line = 0;
  for (const ToolRow& row : rows) {
    if (row.command[0] == 0) {
      const ImVec2 at = ImGui::GetCursorScreenPos();
      ImGui::GetWindowDrawList()->AddRectFilled({at.x + px(3), at.y + px(3)}, {at.x + width - px(13), at.y + px(4)},
                                                packed(theme().line));
      ImGui::Dummy({side, px(7)});
      in_line = 0;
      continue;
    }
    if (in_line > 0) ImGui::SameLine(0, px(2));
    in_line = (in_line + 1) % columns;
    const bool chosen = row.tool >= 0 && ui.context.view.tool == static_cast<Tool>(row.tool);
    command_button(ui, row.command, row.icon, side, chosen ? theme().text : color_of(row.tint), chosen);
  }
  ImGui::End();
  ImGui::PopStyleVar(3);
}

void show_switches(Ui& ui) {
  View& view = ui.context.view;
  const char* depths[] = {"Visible only", "Through"};
  const char* depth_help[] = {"Selecting reaches only what is seen", "Selecting reaches what stands behind, too"};
  const char* spaces[] = {"Local", "World"};
  const char* space_help[] = {"Handles move along axes that turned with them",
                              "Handles move along the axes of the scene"};
  const bool handle = ui.context.session.chosen_handle().has_value();
  float width = 2 * px(4);
  for (const char* name : depths) width += std::round(ImGui::CalcTextSize(name).x) + px(18);
  if (handle) {
    width += px(17);
    for (const char* name : spaces) width += std::round(ImGui::CalcTextSize(name).x) + px(18);
  }
  const float left = tools_right(ui);
  const float top = ui.layout.top + px(measure::edge), height = px(measure::row) + 2 * px(4);
  const ImVec4 panel = choosing_panel(ui);  // that may need their room
  const bool covered = panel.z > 0 && panel.y < top + height && panel.x < left + width;
  if (covered || left + width > ui.layout.column) return;  // View and Select have the same switches
  panel_style();
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(4), px(4)));
  widget::begin_panel("switches", {left, top}, {width, height});
  const int depth = widget::switch_of("depth", depths, view.depth == Depth::VisibleOnly ? 0 : 1, depth_help);
  if (depth >= 0) {
    view.depth = depth == 0 ? Depth::VisibleOnly : Depth::Through;
    ui.context.preferences.through = depth == 1;
  }
  if (handle) {
    ImGui::SameLine(0, px(8));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled({at.x, at.y + px(5)}, {at.x + px(1), at.y + px(19)},
                                              packed(theme().line));
    ImGui::SameLine(0, px(17));
    const int space = widget::switch_of("space", spaces, view.space == Space::Local ? 0 : 1, space_help);
    if (space >= 0) view.space = space == 0 ? Space::Local : Space::World;
  }
  ImGui::End();
  ImGui::PopStyleVar(4);
}

}  // namespace

float tools_right(const Ui& ui) {
  return px(measure::edge) * 2 + bar_width(columns_of(ui));
}

void show_tools(Ui& ui) {
  if (!ui.context.session.has_input()) return;
  show_bar(ui);
  show_switches(ui);
}

}  // namespace sinew::editor
