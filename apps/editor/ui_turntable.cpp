#include <fmt/format.h>
#include <imgui.h>

#include "apps/editor/gui.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

void whole(const char* name, const char* help, int least, int most, const char* unit, int& value) {
  widget::label(name, help);
  ImGui::PushID(name);
  double shown = value;
  widget::number("##value", shown, {static_cast<double>(least), static_cast<double>(most), true, false, unit});
  value = static_cast<int>(shown);
  ImGui::PopID();
}

}  // namespace

void show_turntable(Ui& ui) {
  if (!widget::begin_dialog(ui.turntable, "turntable", 360, 196)) return;
  TurntableChoice& choice = ui.turntable_choice;
  ImGui::PushFont(fonts().bold);
  ImGui::TextUnformatted("Save turntable");
  ImGui::PopFont();
  ImGui::Dummy({0, px(4)});
  whole("Pictures", "How many PNG files are written", 2, 3600, "PNG", choice.pictures);
  widget::label("Turn", "How far around the shape they go; whole turns end a step before the first picture");
  widget::number("##degrees", choice.degrees, {-3600, 3600, false, false, "degrees"});
  whole("Width", "Of each picture", 16, 8192, "pixels", choice.width);
  whole("Height", "Of each picture", 16, 8192, "pixels", choice.height);
  ImGui::Dummy({0, px(8)});
  const float cancel = px(96);
  const char* action = "Choose a name…";
  const float go = ImGui::CalcTextSize(action).x + px(32);
  ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - cancel - go - px(8));
  if (widget::button("Cancel", false, cancel)) ui.turntable = false;
  ImGui::SameLine(0, px(8));
  // The key that opened the dialog is no answer to it.
  const bool entered = !ImGui::IsWindowAppearing() && !ImGui::IsAnyItemActive() &&
                       ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false);
  const bool named = widget::button(action, true, go) || entered;
  if (named) ui.turntable = false;
  widget::end_dialog(ui.turntable);
  if (named) ui.context.request(Request::TurntableName);
}

}  // namespace sinew::editor
