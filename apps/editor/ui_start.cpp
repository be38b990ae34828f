#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/editor/gui.h"
#include "apps/editor/icons.h"
#include "apps/editor/input.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

constexpr double toast_seconds = 6;
constexpr double job_patience = 0.2;  ///< what takes less is not shown

void centred(const std::string& text, ImFont* font, const ImVec4& color) {
  ImGui::PushFont(font);
  ImGui::SetCursorPosX(std::round(0.5f * (ImGui::GetWindowWidth() - ImGui::CalcTextSize(text.c_str()).x)));
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

void show_recent(Ui& ui, float width) {
  const std::vector<std::string>& recent = ui.context.preferences.recent;
  std::size_t shown = 0;
  for (const std::string& path : recent) {
    std::error_code error;
    if (!std::filesystem::exists(path, error)) continue;
    if (shown == 0) {
      ImGui::Dummy({0, px(20)});
      widget::heading("RECENT", true);
    }
    if (++shown > 6) break;
    ImGui::PushID(path.c_str());
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool pressed = ImGui::InvisibleButton("recent", {width, px(28)});
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (ImGui::IsItemHovered())
      list->AddRectFilled({at.x - px(8), at.y}, {at.x + width + px(8), at.y + px(28)}, packed(theme().hover), px(4));
    const float y = at.y + std::round(0.5f * (px(28) - ImGui::GetFontSize()));
    const std::string name = std::filesystem::path(path).filename().string();
    const std::string folder = std::filesystem::path(path).parent_path().string();
    const std::string name_shown = widget::cut(name, 0.5f * width);
    const float name_width = ImGui::CalcTextSize(name_shown.c_str()).x;
    widget::text_at(list, ImGui::GetFont(), {at.x, y}, theme().text, name_shown);
    const std::string folder_shown = widget::cut(folder, width - name_width - px(16));
    widget::text_at(list, ImGui::GetFont(), {at.x + width - ImGui::CalcTextSize(folder_shown.c_str()).x, y},
                    theme().faint, folder_shown);
    ImGui::PopID();
    if (pressed) ui.context.session.open(path);
  }
}

}  // namespace

void show_start(Ui& ui) {
  if (ui.context.session.has_input() || ui.context.session.job()) return;
  const float width = px(440), height = std::min(px(420), ui.layout.bottom - ui.layout.top - px(16));
  const ImVec2 at{std::round(0.5f * (ui.layout.width - width)),
                  std::round(std::max(ui.layout.top + px(8), 0.44f * (ui.layout.height - height)))};
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(24), px(16)));
  widget::begin_panel("start", at, {width, height}, ImGuiWindowFlags_NoBackground);
  centred("Bend anything that is made of points", fonts().big, theme().text);
  ImGui::Dummy({0, px(2)});
  centred("Open a scan, a mesh or a polygon soup, or drop a file here.", fonts().text, theme().quiet);
  ImGui::Dummy({0, px(12)});
  const float button = px(132), buttons = ui.sample.empty() ? button : 2 * button + px(12);
  ImGui::SetCursorPosX(std::round(0.5f * (width - buttons)));
  if (widget::button("Open…", true, button)) run(ui, "file.open");
  if (!ui.sample.empty()) {
    ImGui::SameLine(0, px(12));
    if (widget::button("Sample scan", false, button)) ui.context.session.open(ui.sample);
  }
  show_recent(ui, width - 2 * px(24));
  ImGui::End();
  ImGui::PopStyleVar();
}

void show_job(Ui& ui) {
  const std::optional<Job> job = ui.context.session.job();
  if (!job) return;
  if (job->seconds < job_patience) {
    ui.next_frame = std::min(ui.next_frame, now() + job_patience - job->seconds);
    return;
  }
  const float width = px(340), height = px(64);
  const float middle = 0.5f * (ui.context.session.has_input() ? ui.layout.column : ui.layout.width);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(6));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(12), px(10)));
  widget::begin_panel("job", {std::round(middle - 0.5f * width), ui.layout.bottom - height - px(16)}, {width, height});
  const ImVec2 start = ImGui::GetCursorScreenPos();
  const float cancel = job->can_cancel ? px(72) : 0;
  std::string state;
  if (job->fraction >= 0) {
    state = fmt::format("{:.0f} %", 100 * std::min(1.0, job->fraction));
    if (job->fraction > 0.03 && job->seconds > 1)
      state += fmt::format(" · {:.0f} s left", std::ceil(job->seconds / job->fraction - job->seconds));
  }
  const float room = width - px(24) - cancel - (job->can_cancel ? px(8) : 0);
  const float state_width = ImGui::CalcTextSize(state.c_str()).x;
  ImGui::SetCursorScreenPos({start.x, start.y + px(4)});
  widget::text_cut(job->what, room - state_width - px(12), theme().text);
  widget::text_at(ImGui::GetWindowDrawList(), ImGui::GetFont(), {start.x + room - state_width, start.y + px(4)},
                  theme().faint, state);
  const ImVec2 bar{start.x, start.y + px(32)};
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(bar, {bar.x + room, bar.y + px(6)}, packed(theme().field), px(3));
  if (job->fraction >= 0) {
    const float part = static_cast<float>(std::clamp(job->fraction, 0.0, 1.0));
    list->AddRectFilled(bar, {bar.x + std::max(px(6), std::round(room * part)), bar.y + px(6)}, packed(theme().accent),
                        px(3));
  } else {
    const float at = static_cast<float>(std::fmod(job->seconds * 0.7, 1.0)), piece = 0.25f * room;
    const float x0 = bar.x + std::max(0.0f, at * (room + piece) - piece),
                x1 = bar.x + std::min(room, at * (room + piece));
    list->AddRectFilled({x0, bar.y}, {x1, bar.y + px(6)}, packed(theme().accent), px(3));
  }
  if (job->can_cancel) {
    ImGui::SetCursorScreenPos({start.x + width - px(24) - cancel, start.y + px(8)});
    if (widget::button("Cancel", false, cancel)) ui.context.session.cancel_job();
  }
  ImGui::End();
  ImGui::PopStyleVar(2);
  ui.wants_frames = true;
}

namespace {

/// Warnings and errors stay until they are closed.
bool passes(const Notice& notice) {
  return notice.severity != Severity::Warning && notice.severity != Severity::Error;
}

/// One message; false when it is to go.
bool show_toast(const Toast& toast, float right, float& bottom, int number) {
  const bool bad = !passes(toast.notice);
  const float width = std::min(px(420), right - px(72));
  const float text_width = width - px(12 + 24 + 28 + 4);
  const ImVec2 text = ImGui::CalcTextSize(toast.notice.text.c_str(), nullptr, false, text_width);
  const float height = std::round(text.y) + px(20);
  bottom -= height;
  const ImVec2 at{right - width, bottom};
  bottom -= px(8);
  ImGui::PushStyleColor(ImGuiCol_WindowBg, theme().popup);
  widget::begin_panel(fmt::format("toast {}", number).c_str(), at, {width, height});
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->AddRectFilled(at, {at.x + px(3), at.y + height}, packed(bad ? theme().warning : theme().accent));
  widget::text_at(list, ImGui::GetFont(), {at.x + px(14), at.y + px(10)}, bad ? theme().warning : theme().accent,
                  bad ? icon::warning : icon::info);
  ImGui::SetCursorScreenPos({at.x + px(36), at.y + px(10)});
  ImGui::PushTextWrapPos(px(36) + text_width);
  ImGui::TextUnformatted(toast.notice.text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::SetCursorScreenPos({at.x + width - px(28), at.y + px(6)});
  const bool closed = widget::icon_button(icon::close, "close", false, px(22), theme().quiet, "Close");
  const bool hovered = ImGui::IsWindowHovered();
  ImGui::End();
  ImGui::PopStyleColor();
  return !closed && (bad || hovered || now() - toast.since < toast_seconds);
}

void show_hints(Ui& ui) {
  if (!ui.context.session.has_input() || ui.context.view.manipulation) return;
  std::vector<Notice> hints = ui.context.session.hints();
  if (ui.context.session.layer() == nullptr) {
    const bool selected = !ui.context.session.selection().empty();
    hints = {{Severity::Hint, selected ? "H makes the selected points a handle, K fixes them"
                                       : "Select points to bend the shape by, or to keep where they are"}};
  }
  if (hints.empty()) return;
  const std::string& text = hints.front().text;
  const float room = ui.layout.column - px(2 * measure::edge + 2 * measure::tool_column + 48);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, room);
  const ImVec2 box{std::round(size.x) + px(48), std::round(size.y) + px(14)};
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(6));
  const ImVec2 at{std::round(0.5f * (ui.layout.column - box.x)), ui.layout.bottom - box.y - px(16)};
  widget::begin_panel("hint", at, box, ImGuiWindowFlags_NoInputs);
  widget::text_at(ImGui::GetWindowDrawList(), ImGui::GetFont(), {at.x + px(12), at.y + px(7)}, theme().accent,
                  icon::info);
  ImGui::SetCursorScreenPos({at.x + px(34), at.y + px(7)});
  ImGui::PushTextWrapPos(px(34) + room);
  ImGui::PushStyleColor(ImGuiCol_Text, theme().text);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
  ImGui::PopTextWrapPos();
  ImGui::End();
  ImGui::PopStyleVar();
}

}  // namespace

void show_toasts(Ui& ui) {
  for (Notice& notice : ui.context.session.take_notices()) ui.toasts.push_back({std::move(notice), now()});
  const float right = (ui.context.session.has_input() ? ui.layout.column : ui.layout.width) - px(12);
  float bottom = ui.layout.bottom - px(12);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(6));
  for (std::size_t i = ui.toasts.size(); i-- > 0;) {
    if (bottom < ui.layout.top + px(80) || !show_toast(ui.toasts[i], right, bottom, static_cast<int>(i)))
      ui.toasts.erase(ui.toasts.begin() + static_cast<std::ptrdiff_t>(i));
  }
  ImGui::PopStyleVar();
  for (const Toast& toast : ui.toasts)
    if (passes(toast.notice))
      ui.next_frame = std::min(ui.next_frame, std::max(now() + 0.2, toast.since + toast_seconds));
  if (ui.toasts.empty() && !ui.context.session.job()) show_hints(ui);
}

}  // namespace sinew::editor
