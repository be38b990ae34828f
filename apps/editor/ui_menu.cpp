#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/editor/gui.h"
#include "apps/editor/icons.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

/// The first part of a menu path: "Select" of "Select/Shape".
std::string_view root_of(std::string_view menu) {
  return menu.substr(0, menu.find('/'));
}

std::string first_shortcut(const Command& command) {
  const std::string all = command.shortcut;
  return all.substr(0, all.find(", "));
}

void show_item(Ui& ui, const Command& command) {
  if (command.separator) ImGui::Separator();
  const bool checked = command.checked != nullptr && command.checked(ui.context);
  const bool enabled = command.enabled == nullptr || command.enabled(ui.context);
  if (ImGui::MenuItem(command.title, first_shortcut(command).c_str(), checked, enabled))
    run_command(command, ui.context);
  if (!enabled && command.why_not != nullptr && ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled))
    if (const std::string why = command.why_not(ui.context); !why.empty()) widget::tooltip(why);
}

/// BeginMenu of a popup that fits below the bar and scrolls if it must. A taller one would be pushed up over the bar,
/// under the mouse, and the release of the click that opens it would choose a row.
bool begin_menu(const std::string& name) {
  const float height =
      ImGui::GetIO().DisplaySize.y - px(measure::menu_bar) - 2 * ImGui::GetStyle().DisplaySafeAreaPadding.y;
  ImGui::SetNextWindowSizeConstraints({0, 0}, {FLT_MAX, std::max(px(measure::row), height)});
  return ImGui::BeginMenu(name.c_str());
}

/// Rows of one menu path, with its submenus where their first row stands.
void show_rows(Ui& ui, const std::string& menu) {
  std::vector<std::string> shown;
  for (const Command& command : commands()) {
    const std::string path = command.menu;
    if (path == menu) {
      show_item(ui, command);
    } else if (path.starts_with(menu + "/")) {
      const std::string name = path.substr(menu.size() + 1, path.find('/', menu.size() + 1) - menu.size() - 1);
      if (std::find(shown.begin(), shown.end(), name) != shown.end()) continue;
      shown.push_back(name);
      if (begin_menu(name)) {
        show_rows(ui, menu + "/" + name);
        ImGui::EndMenu();
      }
    }
  }
}

/// "bunny.ply · edited", flush right.
void show_name(Ui& ui) {
  const Session& session = ui.context.session;
  if (!session.has_input()) return;
  const std::string path = session.edit_path().empty() ? session.input_path() : session.edit_path();
  const std::string name = std::filesystem::path(path).filename().string();
  const std::string state = session.dirty() ? "  ·  edited" : "";
  const float room = ImGui::GetContentRegionAvail().x - px(24);
  const float state_width = ImGui::CalcTextSize(state.c_str()).x;
  if (room < px(60)) return;
  const std::string shown = widget::cut(name, room - state_width) + state;
  ImGui::SetCursorPosX(ImGui::GetWindowWidth() - ImGui::CalcTextSize(shown.c_str()).x - px(measure::pad));
  ImGui::PushStyleColor(ImGuiCol_Text, theme().quiet);
  ImGui::TextUnformatted(shown.c_str());
  ImGui::PopStyleColor();
  if (ImGui::IsItemHovered()) widget::tooltip(path);
}

}  // namespace

std::string grouped(std::size_t number) {
  std::string digits = std::to_string(number);
  for (std::ptrdiff_t at = static_cast<std::ptrdiff_t>(digits.size()) - 3; at > 0; at -= 3)
    digits.insert(static_cast<std::size_t>(at), ",");
  return digits;
}

void run(Ui& ui, const char* command) {
  if (const Command* found = find_command(command)) run_command(*found, ui.context);
}

bool command_button(Ui& ui, const char* command, const char* icon, float side, const ImVec4& color, bool chosen) {
  const Command* found = find_command(command);
  if (found == nullptr) return false;
  const bool enabled = found->enabled == nullptr || found->enabled(ui.context);
  ImGui::BeginDisabled(!enabled);
  const std::string why = !enabled && found->why_not != nullptr ? found->why_not(ui.context) : "";
  const std::string help = why.empty() ? found->title : fmt::format("{}\n{}", found->title, why);
  const bool pressed = widget::icon_button(icon, command, chosen, side, color, help, first_shortcut(*found));
  ImGui::EndDisabled();
  if (pressed) run_command(*found, ui.context);
  return pressed;
}

void show_menu(Ui& ui) {
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                      ImVec2(px(8), std::floor(0.5f * (px(measure::menu_bar) - ImGui::GetFontSize()))));
  const bool narrow = ui.layout.width < px(520);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(narrow ? 8 : 14), px(6)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(8), px(8)));
  ImGui::PushStyleColor(ImGuiCol_MenuBarBg, theme().panel);
  if (ImGui::BeginMainMenuBar()) {
    ImGui::SetCursorPosX(px(measure::pad));
    ImGui::PushFont(fonts().bold);
    ImGui::TextUnformatted("Sinew");
    ImGui::PopFont();
    ImGui::SameLine(0, px(narrow ? 10 : 20));
    std::vector<std::string_view> roots;
    for (const Command& command : commands()) {
      const std::string_view root = root_of(command.menu);
      if (root.empty() || std::find(roots.begin(), roots.end(), root) != roots.end()) continue;
      roots.push_back(root);
      const std::string name(root);
      if (begin_menu(name)) {
        show_rows(ui, name);
        ImGui::EndMenu();
      }
    }
    show_name(ui);
    widget::edge_line({0, 1}, {1, 1});
    ImGui::EndMainMenuBar();
  }
  ImGui::PopStyleColor();
  ImGui::PopStyleVar(3);
}

}  // namespace sinew::editor
