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
constexpr std::ptrdiff_t most_toasts = 3;
constexpr double job_patience = 0.2;  ///< what takes less is not shown
constexpr float job_width = 380, job_height = 64;

/// The work that is shown now: the session's first.
std::optional<Job> shown_job(const Ui& ui) {
  const std::optional<Job> own = ui.context.session.job();
  return own ? own : ui.drawing;
}

void centred(const std::string& text, ImFont* font, const ImVec4& color) {
  ImGui::PushFont(font);
  ImGui::SetCursorPosX(std::round(0.5f * (ImGui::GetWindowWidth() - ImGui::CalcTextSize(text.c_str()).x)));
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopStyleColor();
  ImGui::PopFont();
}

constexpr float card_width = 144, picture_height = 96, card_height = 140, card_gap = 16;

/// A recent file: its picture, or an icon where there is none, its name and its folder.
void show_card(Ui& ui, const std::string& path, ImVec2 at) {
  ImGui::PushID(path.c_str());
  ImGui::SetCursorScreenPos(at);
  const bool pressed = ImGui::InvisibleButton("recent", {px(card_width), px(card_height)});
  const bool hovered = ImGui::IsItemHovered();
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 end{at.x + px(card_width), at.y + px(picture_height)};
  list->AddRectFilled(at, end, packed(theme().field), px(4));
  const auto found = std::find(ui.pictured.begin(), ui.pictured.end(), path);
  const auto picture = static_cast<std::size_t>(found - ui.pictured.begin());
  if (picture < fonts().pictures.size()) {
    const Fonts::Place& place = fonts().pictures[picture];
    list->AddImageRounded(ImGui::GetIO().Fonts->TexID, at, end, place.from, place.to, IM_COL32_WHITE, px(4));
  } else {
    const ImVec2 size = widget::size_of(fonts().icons, icon::cube);
    widget::text_at(list, fonts().icons, {0.5f * (at.x + end.x - size.x), 0.5f * (at.y + end.y - size.y)},
                    theme().faint, icon::cube);
  }
  list->AddRect(at, end, packed(hovered ? theme().accent : theme().line), px(4), 0, px(hovered ? 2 : 1));
  const std::filesystem::path file(path);
  widget::text_at(list, ImGui::GetFont(), {at.x, end.y + px(6)}, theme().text,
                  widget::cut(file.filename().string(), px(card_width)));
  widget::text_at(list, ImGui::GetFont(), {at.x, end.y + px(24)}, theme().faint,
                  widget::cut(file.parent_path().filename().string(), px(card_width)));
  if (hovered) widget::tooltip(path);
  ImGui::PopID();
  if (pressed) ui.context.session.open(path);
}

/// A recent file where there is no room for cards.
void show_row(Ui& ui, const std::string& path, float width) {
  ImGui::PushID(path.c_str());
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool pressed = ImGui::InvisibleButton("recent", {width, px(measure::row)});
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (ImGui::IsItemHovered())
    list->AddRectFilled({at.x - px(8), at.y}, {at.x + width + px(8), at.y + px(measure::row)}, packed(theme().hover),
                        px(4));
  const float y = at.y + std::round(0.5f * (px(measure::row) - ImGui::GetFontSize()));
  const std::filesystem::path file(path);
  const std::string name = widget::cut(file.filename().string(), 0.6f * width);
  const std::string folder = widget::cut(file.parent_path().filename().string(), 0.35f * width);
  widget::text_at(list, ImGui::GetFont(), {at.x, y}, theme().text, name);
  widget::text_at(list, ImGui::GetFont(), {at.x + width - ImGui::CalcTextSize(folder.c_str()).x, y}, theme().faint,
                  folder);
  ImGui::PopID();
  if (pressed) ui.context.session.open(path);
}

std::vector<std::string> existing(const std::vector<std::string>& recent) {
  std::vector<std::string> out;
  for (const std::string& path : recent) {
    std::error_code error;
    const bool run = std::filesystem::path(path).filename().string().find_first_of("#%@") != std::string::npos;
    if (run || std::filesystem::exists(path, error)) out.push_back(path);
  }
  return out;
}

/// Cards, as many as there is room for, two rows at most; where not even one row fits, names.
void show_recent(Ui& ui) {
  const std::vector<std::string> files = existing(ui.context.preferences.recent);
  if (files.empty() || ImGui::GetContentRegionAvail().y < px(12 + 24 + measure::row)) return;
  ImGui::Dummy({0, px(12)});
  widget::heading("RECENT", true);
  const ImVec2 at = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  const auto fits = [](float space, float size, float gap) {
    return static_cast<std::size_t>(std::max(0.0f, (space + gap) / (size + gap)));
  };
  const std::size_t across = fits(room.x, px(card_width), px(card_gap));
  const std::size_t rows = std::min<std::size_t>(2, fits(room.y, px(card_height), px(4)));
  if (across * rows == 0) {
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(0, 0));
    for (std::size_t i = 0; i < std::min(files.size(), fits(room.y, px(measure::row), 0)); ++i)
      show_row(ui, files[i], room.x);
    ImGui::PopStyleVar();
    return;
  }
  for (std::size_t i = 0; i < std::min(files.size(), rows * across); ++i)
    show_card(ui, files[i],
              {at.x + static_cast<float>(i % across) * px(card_width + card_gap),
               at.y + static_cast<float>(i / across) * px(card_height + 4)});
}

}  // namespace

void show_start(Ui& ui) {
  if (ui.context.session.has_input() || ui.context.session.job()) return;
  const float width = std::min(px(3 * card_width + 2 * card_gap + 48), ui.layout.width - px(16)),
              height = std::min(px(476), ui.layout.bottom - ui.layout.top - px(16));
  const ImVec2 at{std::round(0.5f * (ui.layout.width - width)),
                  std::round(std::max(ui.layout.top + px(8), 0.44f * (ui.layout.height - height)))};
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(24), px(16)));
  widget::begin_panel("start", at, {width, height}, ImGuiWindowFlags_NoBackground);
  centred("Bend anything that is made of points", fonts().big, theme().text);
  ImGui::Dummy({0, px(2)});
  centred("Open a scan, a mesh or a polygon soup, or drop a file here.", fonts().text, theme().quiet);
  ImGui::Dummy({0, px(8)});
  const float button = px(132), buttons = ui.sample.empty() ? button : 2 * button + px(12);
  ImGui::SetCursorPosX(std::round(0.5f * (width - buttons)));
  if (widget::button("Open…", true, button)) run(ui, "file.open");
  if (!ui.sample.empty()) {
    ImGui::SameLine(0, px(12));
    if (widget::button("Sample scan", false, button)) ui.context.session.open(ui.sample);
  }
  show_recent(ui);
  ImGui::End();
  ImGui::PopStyleVar();
}

void show_job(Ui& ui) {
  const std::optional<Job> job = shown_job(ui);
  if (!job) return;
  if (job->seconds < job_patience) {
    ui.next_frame = std::min(ui.next_frame, now() + job_patience - job->seconds);
    return;
  }
  const float width = px(job_width), height = px(job_height);
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
    if (widget::button("Cancel", false, cancel))
      ui.context.session.job() ? ui.context.session.cancel_job() : ui.cancel_drawing();
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

/// The command that a notice offers, while it can be run and nothing was edited: then something else is being done.
const Command* offered(const Ui& ui, const Notice& notice) {
  if (ui.context.session.dirty()) return nullptr;
  const Command* command = notice.command.empty() ? nullptr : find_command(notice.command);
  return command != nullptr && command->enabled(ui.context) ? command : nullptr;
}

/// One message; false when it is to go.
bool show_toast(Ui& ui, const Toast& toast, float right, float& bottom, int number) {
  const bool bad = !passes(toast.notice);
  const Command* command = offered(ui, toast.notice);
  const float width = std::min(px(420), right - px(72));
  const float text_width = width - px(12 + 24 + 28 + 4);
  const ImVec2 text = ImGui::CalcTextSize(toast.notice.text.c_str(), nullptr, false, text_width);
  const float height = std::round(text.y) + px(20) + (command != nullptr ? px(32) : 0);
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
  bool taken = false;
  if (command != nullptr) {
    ImGui::SetCursorScreenPos({at.x + px(36), at.y + std::round(text.y) + px(16)});
    taken = widget::button(command->title, true);
  }
  ImGui::SetCursorScreenPos({at.x + width - px(28), at.y + px(6)});
  const bool closed = widget::icon_button(icon::close, "close", false, px(22), theme().quiet, "Close");
  const bool hovered = ImGui::IsWindowHovered();
  ImGui::End();
  ImGui::PopStyleColor();
  if (taken) run_command(*command, ui.context);
  return !closed && !taken && (bad || command != nullptr || hovered || now() - toast.since < toast_seconds);
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
  if (std::ssize(ui.toasts) > most_toasts) ui.toasts.erase(ui.toasts.begin(), ui.toasts.end() - most_toasts);
  const float right = (ui.context.session.has_input() ? ui.layout.column : ui.layout.width) - px(12);
  float bottom = ui.layout.bottom - px(12);
  // Above the work with its button.
  if (const std::optional<Job> job = shown_job(ui); job && job->seconds >= job_patience) bottom -= px(job_height + 12);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(6));
  for (std::size_t i = ui.toasts.size(); i-- > 0;) {
    if (bottom < ui.layout.top + px(80) || !show_toast(ui, ui.toasts[i], right, bottom, static_cast<int>(i)))
      ui.toasts.erase(ui.toasts.begin() + static_cast<std::ptrdiff_t>(i));
  }
  ImGui::PopStyleVar();
  for (const Toast& toast : ui.toasts)
    if (passes(toast.notice))
      ui.next_frame = std::min(ui.next_frame, std::max(now() + 0.2, toast.since + toast_seconds));
  if (ui.toasts.empty() && !shown_job(ui)) show_hints(ui);
}

}  // namespace sinew::editor
