#include <imgui.h>

#include "apps/editor/gui.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

/// What a killed program left, one journal after the other.
void show_recovery(Ui& ui) {
  const document::OldJournal* journal = ui.recovery.offered();
  if (journal == nullptr || ui.navigation_choice || !ui.ask.text.empty()) return;
  bool shown = true;
  if (!widget::begin_dialog(shown, "recovery", 460, 176)) return;
  ImGui::PushFont(fonts().big);
  ImGui::TextUnformatted("Recover unsaved work?");
  ImGui::PopFont();
  ImGui::Dummy({0, px(4)});
  ImGui::PushFont(fonts().bold);
  widget::text_cut(what_of(*journal), ImGui::GetContentRegionAvail().x, theme().text);
  ImGui::PopFont();
  ImGui::PushTextWrapPos(0);
  ImGui::PushStyleColor(ImGuiCol_Text, theme().quiet);
  ImGui::TextUnformatted(details_of(*journal).c_str());
  ImGui::TextUnformatted("Sinew was ended before it could be saved. Recovering opens it with all steps to undo.");
  ImGui::PopStyleColor();
  ImGui::PopTextWrapPos();
  const float width = px(104), gap = px(8);
  ImGui::SetCursorPos({ImGui::GetWindowWidth() - 3 * width - 2 * gap - px(12), ImGui::GetWindowHeight() - px(28 + 12)});
  const bool later = widget::button("Later", false, width);
  ImGui::SameLine(0, gap);
  const bool discard = widget::button("Discard", false, width);
  ImGui::SameLine(0, gap);
  // Enter may have closed the dialog before this one.
  const bool entered = !ImGui::IsWindowAppearing() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false);
  const bool recover = widget::button("Recover", true, width) || entered;
  widget::end_dialog(shown);
  if (recover) {
    ui.context.session.recover(ui.recovery.recover());
    ui.recovery.all_later();
  } else if (discard) {
    ui.recovery.discard();
  } else if (later || !shown) {
    ui.recovery.later();
  }
}

}  // namespace sinew::editor
