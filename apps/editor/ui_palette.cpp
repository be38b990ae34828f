#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "apps/editor/gui.h"
#include "apps/editor/icons.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

bool key_pressed(ImGuiKey key) {
  return ImGui::IsKeyPressed(ImGui::GetKeyIndex(key));
}

/// A row of title and shortcut; true when clicked.
bool command_row(Ui& ui, const Command& command, bool chosen) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float width = ImGui::GetContentRegionAvail().x, height = px(28);
  const bool pressed = ImGui::InvisibleButton(command.id, {width, height});
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (chosen || ImGui::IsItemHovered())
    list->AddRectFilled(at, {at.x + width, at.y + height}, packed(chosen ? theme().chosen : theme().hover), px(4));
  const bool enabled = command.enabled == nullptr || command.enabled(ui.context);
  const float y = at.y + std::round(0.5f * (height - ImGui::GetFontSize()));
  const ImVec4 color = enabled ? theme().text : theme().faint;
  std::string path;
  for (const char c : std::string(command.menu)) path += c == '/' ? " › " : std::string(1, c);
  if (!path.empty()) path += " › ";
  widget::text_at(list, ImGui::GetFont(), {at.x + px(10), y}, theme().faint, path);
  widget::text_at(list, ImGui::GetFont(), {at.x + px(10) + ImGui::CalcTextSize(path.c_str()).x, y}, color,
                  command.title);
  const std::string shortcut = command.shortcut;
  widget::text_at(list, ImGui::GetFont(), {at.x + width - px(10) - ImGui::CalcTextSize(shortcut.c_str()).x, y},
                  theme().quiet, shortcut);
  return pressed;
}

}  // namespace

void show_palette(Ui& ui) {
  if (!widget::begin_dialog(ui.palette, "palette", 520, 400)) return;
  if (ImGui::IsWindowAppearing()) {
    ui.palette_text.clear();
    ui.palette_row = 0;
    ImGui::SetKeyboardFocusHere();
  }
  ImGui::SetNextItemWidth(-FLT_MIN);
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(10), px(7)));
  if (ImGui::InputTextWithHint("##text", "Type what you want to do", &ui.palette_text)) ui.palette_row = 0;
  ImGui::PopStyleVar();
  const std::vector<const Command*> found = search_commands(ui.palette_text);
  const int last = static_cast<int>(found.size()) - 1;
  const int row_before = ui.palette_row;
  if (key_pressed(ImGuiKey_DownArrow)) ui.palette_row = std::min(last, ui.palette_row + 1);
  if (key_pressed(ImGuiKey_UpArrow)) ui.palette_row = std::max(0, ui.palette_row - 1);
  const Command* taken = nullptr;
  if (key_pressed(ImGuiKey_Enter) && ui.palette_row <= last && last >= 0)
    taken = found[static_cast<std::size_t>(ui.palette_row)];
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, 0));
  ImGui::Dummy({0, px(4)});
  ImGui::BeginChild("found", {0, 0}, false, ImGuiWindowFlags_NoNav);
  for (int i = 0; i <= last; ++i) {
    const Command& command = *found[static_cast<std::size_t>(i)];
    if (command_row(ui, command, i == ui.palette_row)) taken = &command;
    if (i == ui.palette_row && row_before != ui.palette_row) ImGui::SetScrollHereY(0.5f);
  }
  if (found.empty()) ImGui::TextDisabled("No command has these words.");
  ImGui::EndChild();
  ImGui::PopStyleVar();
  if (taken != nullptr) ui.palette = false;
  widget::end_dialog(ui.palette);
  if (taken != nullptr) run_command(*taken, ui.context);
}

namespace {

/// Height of a menu's block in the keymap.
int block_rows(const std::vector<const Command*>& block) {
  return static_cast<int>(block.size()) + 2;
}

void show_block(const std::string& name, const std::vector<const Command*>& block, float width) {
  widget::heading(name, true);
  for (const Command* command : block) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const std::string keys = command->shortcut;
    const float keys_width = ImGui::CalcTextSize(keys.c_str()).x;
    widget::text_at(list, ImGui::GetFont(), at, theme().text, widget::cut(command->title, width - keys_width - px(12)));
    widget::text_at(list, ImGui::GetFont(), {at.x + width - keys_width, at.y}, theme().quiet, keys);
    ImGui::Dummy({width, px(20)});
  }
  ImGui::Dummy({0, px(8)});
}

}  // namespace

void show_keymap(Ui& ui) {
  if (!widget::begin_dialog(ui.keymap, "keymap", 920, 544)) return;
  ImGui::PushFont(fonts().bold);
  ImGui::TextUnformatted("Keys and mouse");
  ImGui::PopFont();
  std::vector<std::pair<std::string, std::vector<const Command*>>> blocks;
  for (const Command& command : commands()) {
    if (command.shortcut[0] == 0) continue;
    const std::string menu = command.menu;
    std::string name = menu.substr(0, menu.find('/'));
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    if (blocks.empty() || std::none_of(blocks.begin(), blocks.end(), [&](const auto& b) { return b.first == name; }))
      blocks.emplace_back(name, std::vector<const Command*>{});
    std::find_if(blocks.begin(), blocks.end(), [&](const auto& b) {
      return b.first == name;
    })->second.push_back(&command);
  }
  int all = 0;
  for (const auto& [name, block] : blocks) all += block_rows(block);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(8), 0));
  ImGui::BeginChild("blocks", {0, 0}, false, ImGuiWindowFlags_NoNav);
  const int columns = ImGui::GetContentRegionAvail().x > px(760)   ? 3
                      : ImGui::GetContentRegionAvail().x > px(480) ? 2
                                                                   : 1;
  const float gap = px(32),
              width = std::floor((ImGui::GetContentRegionAvail().x - gap * static_cast<float>(columns - 1) - px(8)) /
                                 static_cast<float>(columns));
  std::size_t next = 0;
  for (int column = 0; column < columns; ++column) {
    if (column > 0) ImGui::SameLine(0, gap);
    ImGui::BeginGroup();
    int rows = 0;
    while (next < blocks.size() && (column == columns - 1 || rows == 0 ||
                                    rows + block_rows(blocks[next].second) / 2 <= (all + columns - 1) / columns)) {
      show_block(blocks[next].first, blocks[next].second, width);
      rows += block_rows(blocks[next++].second);
    }
    if (column == columns - 1) {
      widget::heading("MOUSE", true);
      for (const NavigationBinding& binding : navigation_bindings()) {
        if (binding.preset != ui.context.preferences.navigation) continue;
        ImGui::TextUnformatted(binding.help);
        ImGui::Dummy({0, px(4)});
      }
    }
    ImGui::EndGroup();
  }
  ImGui::EndChild();
  ImGui::PopStyleVar();
  widget::end_dialog(ui.keymap);
}

}  // namespace sinew::editor
