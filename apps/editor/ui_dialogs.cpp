#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/editor/gui.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

void show_about(Ui& ui) {
  if (!widget::begin_dialog(ui.about, "about", 400, 168)) return;
  ImGui::PushFont(fonts().big);
  ImGui::TextUnformatted("Sinew " SINEW_VERSION);
  ImGui::PopFont();
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted("Bends anything that is made of points: scans, meshes, polygon soups.");
  ImGui::PushStyleColor(ImGuiCol_Text, theme().quiet);
  ImGui::TextUnformatted("GPL-3.0-or-later, without any warranty.");
  ImGui::TextUnformatted(("Drawn by " + ui.device + ".").c_str());
  ImGui::PopStyleColor();
  ImGui::PopTextWrapPos();
  ImGui::Dummy({0, px(4)});
  if (widget::button("Close", true)) ui.about = false;
  widget::end_dialog(ui.about);
}

void show_preferences(Ui& ui) {
  if (!widget::begin_dialog(ui.settings, "preferences", 400, 228)) return;
  Preferences& chosen = ui.context.preferences;
  ImGui::PushFont(fonts().bold);
  ImGui::TextUnformatted("Preferences");
  ImGui::PopFont();
  ImGui::Dummy({0, px(4)});
  const std::vector<std::string> themes{"Dark", "Light"};
  std::size_t at = chosen.dark ? 0 : 1;
  widget::label("Theme");
  if (widget::choice("##theme", at, themes)) chosen.dark = at == 0;
  const std::vector<std::string> scales{"As the display", "1", "1.25", "1.5", "2", "3"};
  const double values[] = {0, 1, 1.25, 1.5, 2, 3};
  at = 0;
  for (std::size_t i = 0; i < scales.size(); ++i)
    if (values[i] == chosen.scale) at = i;
  widget::label("Scale");
  if (widget::choice("##scale", at, scales)) chosen.scale = values[at];
  std::vector<std::string> presets;
  for (const NavigationPreset preset : {NavigationPreset::Blender, NavigationPreset::Maya, NavigationPreset::Scan})
    presets.emplace_back(name_of(preset));
  at = static_cast<std::size_t>(chosen.navigation);
  widget::label("Navigation", "What the mouse buttons do to the view");
  if (widget::choice("##navigation", at, presets)) chosen.navigation = static_cast<NavigationPreset>(at);
  const std::vector<std::string> axes{"Y", "Z"};
  at = chosen.up == gpu::UpAxis::Y ? 0 : 1;
  widget::label("Up axis", "Of the view only: files are never turned");
  if (widget::choice("##up", at, axes)) {
    chosen.up = at == 0 ? gpu::UpAxis::Y : gpu::UpAxis::Z;
    ui.context.view.up = chosen.up;
    ui.context.view.camera = levelled(ui.context.view.camera, chosen.up);
  }
  widget::label("System dialogs", "Open and save by the file dialog of the desktop, where there is one");
  widget::checkbox("##native", chosen.native_dialogs);
  ImGui::Dummy({0, px(8)});
  if (widget::button("Done", true)) ui.settings = false;
  widget::end_dialog(ui.settings);
}

/// Asked at the first start: a card a preset, with what its buttons do.
void show_navigation_choice(Ui& ui) {
  if (!widget::begin_dialog(ui.navigation_choice, "navigation", 720, 204)) return;
  Preferences& preferences = ui.context.preferences;
  ImGui::PushFont(fonts().big);
  ImGui::TextUnformatted("How do you move around?");
  ImGui::PopFont();
  ImGui::PushStyleColor(ImGuiCol_Text, theme().quiet);
  ImGui::TextUnformatted("Take what your hand knows. The preferences change it at any time.");
  ImGui::PopStyleColor();
  ImGui::Dummy({0, px(8)});
  const float gap = px(12), width = std::floor((ImGui::GetContentRegionAvail().x - 2 * gap) / 3), height = px(120);
  bool first = true;
  for (const NavigationPreset preset : {NavigationPreset::Blender, NavigationPreset::Maya, NavigationPreset::Scan}) {
    if (!first) ImGui::SameLine(0, gap);
    first = false;
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::InvisibleButton(name_of(preset), {width, height});
    ImDrawList* list = ImGui::GetWindowDrawList();
    const bool hovered = ImGui::IsItemHovered(), now = preferences.navigation == preset;
    list->AddRectFilled(at, {at.x + width, at.y + height}, packed(hovered ? theme().chosen : theme().field), px(6));
    list->AddRect(at, {at.x + width, at.y + height}, packed(now ? theme().accent : theme().line), px(6), 0,
                  px(now ? 2 : 1));
    widget::text_at(list, fonts().bold, {at.x + px(12), at.y + px(10)}, theme().text, name_of(preset));
    float y = at.y + px(36);
    for (const NavigationBinding& binding : navigation_bindings()) {
      if (binding.preset != preset || y > at.y + height - px(20)) continue;
      widget::text_at(list, ImGui::GetFont(), {at.x + px(12), y}, theme().quiet,
                      widget::cut(binding.help, width - px(24)));
      y += px(20);
    }
    if (pressed) {
      preferences.navigation = preset;
      ui.navigation_choice = false;
    }
  }
  if (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter))) ui.navigation_choice = false;
  if (!ui.navigation_choice) preferences.asked_navigation = true;
  widget::end_dialog(ui.navigation_choice);
}

void show_question(Ui& ui) {
  bool shown = !ui.ask.text.empty();
  const bool was_shown = shown;
  const float text = ImGui::CalcTextSize(ui.ask.text.c_str(), nullptr, false, px(396)).y / scale();
  if (widget::begin_dialog(shown, "question", 420, std::max(116.0f, text + 68))) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextUnformatted(ui.ask.text.c_str());
    ImGui::PopTextWrapPos();
    const float keep = px(96), go = ImGui::CalcTextSize(ui.ask.action.c_str()).x + px(32);
    ImGui::SetCursorPos({ImGui::GetWindowWidth() - keep - go - px(8 + 12), ImGui::GetWindowHeight() - px(28 + 12)});
    const bool confirmed = widget::button(ui.ask.action.c_str(), false);
    ImGui::SameLine(0, px(8));
    if (widget::button("Cancel", true, keep) || confirmed) shown = false;
    widget::end_dialog(shown);
    if (confirmed) ui.ask.confirmed();
  }
  if (was_shown && !shown) ui.ask = {};
}

}  // namespace

void show_dialogs(Ui& ui) {
  show_question(ui);
  show_about(ui);
  show_preferences(ui);
  show_navigation_choice(ui);
}

}  // namespace sinew::editor
