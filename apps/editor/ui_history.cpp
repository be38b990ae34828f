#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/editor/gui.h"
#include "apps/editor/icons.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

/// One state, its whole row to click; what was undone is faint.
bool show_step(const document::History& history, std::size_t state) {
  const float width = ImGui::GetContentRegionAvail().x, height = px(measure::row);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::PushID(static_cast<int>(state));
  const bool pressed = ImGui::InvisibleButton("step", {width, height});
  ImGui::PopID();
  const bool present = state == history.position(), undone = state > history.position();
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 end{at.x + width, at.y + height};
  if (present || ImGui::IsItemHovered())
    list->AddRectFilled(at, end, packed(present ? theme().chosen : theme().hover), px(4));
  if (present) list->AddRectFilled(at, {at.x + px(3), end.y}, packed(theme().accent), px(1));
  const float y = at.y + std::round(0.5f * (height - ImGui::GetFontSize()));
  widget::text_at(list, ImGui::GetFont(), {at.x + px(12), y}, undone ? theme().faint : theme().text,
                  widget::cut(history.label(state), width - px(20)));
  return pressed;
}

constexpr float head = 36;  ///< above the steps, with the gap below it

/// Left, top, width and height, pixels: below the axes, beside the column and what else stands there; no width where
/// there is no room.
ImVec4 place_of(const Ui& ui, std::size_t states) {
  const ImVec4 choosing = choosing_panel(ui);
  const float right = (choosing.z > 0 ? choosing.x : legend_left(ui)) - px(measure::edge);
  const float width = std::min(px(248), right - tools_right(ui)), top = ui.layout.top + px(92);
  const float room = ui.layout.bottom - px(16 + 48) - top;  // hints stand below it
  const float rows = static_cast<float>(std::min<std::size_t>(states, 12)) * px(measure::row);
  return {right - width, top, width < px(144) ? 0 : width, std::min(px(head + 8) + rows, room)};
}

void show_head(Ui& ui, const document::History& history) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float right = at.x + ImGui::GetContentRegionAvail().x, close = px(20);
  ImDrawList* list = ImGui::GetWindowDrawList();
  widget::text_at(list, fonts().bold, {at.x + px(4), at.y + px(2)}, theme().text, "History");
  const std::string count = grouped(history.position()) + " of " + grouped(history.size() - 1);
  const float width = ImGui::CalcTextSize(count.c_str()).x;
  widget::text_at(list, ImGui::GetFont(), {right - px(8) - close - width, at.y + px(2)}, theme().faint, count);
  ImGui::SetCursorScreenPos({right - close, at.y});
  if (widget::icon_button(icon::close, "close", false, close, theme().quiet, "Close")) run(ui, "view.history");
  ImGui::SetCursorScreenPos({at.x, at.y + px(head - 8)});
}

/// Scrolls to the present step where it has become another.
void follow_present(Ui& ui, std::size_t present) {
  const float top = static_cast<float>(present) * px(measure::row), now = ImGui::GetScrollY();
  const float page = ImGui::GetWindowHeight();
  if (ui.history_seen != present && (top < now || top + px(measure::row) > now + page))
    ImGui::SetScrollY(std::max(0.0f, top + 0.5f * (px(measure::row) - page)));
  ui.history_seen = present;
}

}  // namespace

/// All steps from the first, in a panel of its own; a click goes there.
void show_history(Ui& ui) {
  Session& session = ui.context.session;
  if (!ui.context.view.show_history || !session.has_input()) return;
  const document::History& history = session.history();
  const ImVec4 place = place_of(ui, history.size());
  if (!(place.z > 0)) return;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(6));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(8), px(8)));
  widget::begin_panel("history", {place.x, place.y}, {place.z, place.w});
  show_head(ui, history);
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, 0));
  ImGui::BeginChild("steps", {0, 0}, false, ImGuiWindowFlags_NoNav);
  follow_present(ui, history.position());
  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(history.size()), px(measure::row));
  std::optional<std::size_t> chosen;
  while (clipper.Step())
    for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
      if (show_step(history, static_cast<std::size_t>(i))) chosen = static_cast<std::size_t>(i);
  ImGui::EndChild();
  ImGui::PopStyleVar();
  ImGui::End();
  ImGui::PopStyleVar(2);
  if (chosen) session.go_to(*chosen);
}

}  // namespace sinew::editor
