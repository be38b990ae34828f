#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>

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

/// A heading with what is done, and by which keys or buttons.
struct KeyBlock {
  std::string name;
  std::vector<std::pair<std::string, std::string>> rows;

  std::size_t height() const { return rows.size() + 2; }  ///< in rows
};

std::string capital(std::string text) {
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

/// "middle button: orbit" as Orbit, Middle button.
KeyBlock mouse_block(NavigationPreset preset) {
  KeyBlock out{"MOUSE", {}};
  for (const NavigationBinding& binding : navigation_bindings()) {
    if (binding.preset != preset) continue;
    const std::string help = binding.help;
    const std::size_t colon = help.find(": ");
    out.rows.emplace_back(capital(help.substr(colon + 2)), capital(help.substr(0, colon)));
  }
  out.rows.emplace_back("Zoom", "Wheel");
  return out;
}

/// The mouse, then a block a menu, in their order.
std::vector<KeyBlock> key_blocks(NavigationPreset preset) {
  std::vector<KeyBlock> out{mouse_block(preset)};
  for (const Command& command : commands()) {
    if (command.shortcut[0] == 0) continue;
    const std::string menu = command.menu;
    std::string name = menu.substr(0, menu.find('/'));
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    auto at = std::find_if(out.begin(), out.end(), [&](const KeyBlock& block) { return block.name == name; });
    if (at == out.end()) at = out.insert(at, KeyBlock{name, {}});
    at->rows.emplace_back(command.title, command.shortcut);
  }
  return out;
}

/// The column of each block: the first in the first, the others from the longest on where least stands yet.
std::vector<std::size_t> columns_of(const std::vector<KeyBlock>& blocks, std::size_t count) {
  std::vector<std::size_t> heights(count, 0), out(blocks.size(), 0), order(blocks.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin() + 1, order.end(),
                   [&](std::size_t a, std::size_t b) { return blocks[a].height() > blocks[b].height(); });
  for (const std::size_t i : order) {
    const auto least = std::min_element(heights.begin(), heights.end());
    out[i] = static_cast<std::size_t>(least - heights.begin());
    *least += blocks[i].height();
  }
  return out;
}

void show_block(const KeyBlock& block, float width) {
  widget::heading(block.name, true);
  for (const auto& [title, keys] : block.rows) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float keys_width = ImGui::CalcTextSize(keys.c_str()).x;
    widget::text_at(list, ImGui::GetFont(), at, theme().text, widget::cut(title, width - keys_width - px(12)));
    widget::text_at(list, ImGui::GetFont(), {at.x + width - keys_width, at.y}, theme().quiet, keys);
    ImGui::Dummy({width, px(20)});
  }
  ImGui::Dummy({0, px(8)});
}

}  // namespace

void show_keymap(Ui& ui) {
  if (!widget::begin_dialog(ui.keymap, "keymap", 1180, 528)) return;
  ImGui::PushFont(fonts().bold);
  ImGui::TextUnformatted("Keys and mouse");
  ImGui::PopFont();
  widget::value_right("Esc closes", theme().quiet);
  const std::vector<KeyBlock> blocks = key_blocks(ui.context.preferences.navigation);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(8), 0));
  ImGui::BeginChild("blocks", {0, 0}, false, ImGuiWindowFlags_NoNav);
  const float whole = ImGui::GetContentRegionAvail().x, gap = px(32);
  const std::size_t count = whole > px(1000) ? 4 : whole > px(760) ? 3 : whole > px(480) ? 2 : 1;
  const auto gaps = static_cast<float>(count - 1);
  const float width = std::floor((whole - gap * gaps - px(8)) / static_cast<float>(count));
  const std::vector<std::size_t> columns = columns_of(blocks, count);
  for (std::size_t column = 0; column < count; ++column) {
    if (column > 0) ImGui::SameLine(0, gap);
    ImGui::BeginGroup();
    for (std::size_t i = 0; i < blocks.size(); ++i)
      if (columns[i] == column) show_block(blocks[i], width);
    ImGui::EndGroup();
  }
  ImGui::EndChild();
  ImGui::PopStyleVar();
  widget::end_dialog(ui.keymap);
}

}  // namespace sinew::editor
