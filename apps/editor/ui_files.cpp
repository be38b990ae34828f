#include "apps/editor/ui_files.h"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <imgui.h>
#include <imgui_stdlib.h>
#include <sys/stat.h>

#include <algorithm>
#include <ctime>
#include <filesystem>

#include "apps/editor/gui.h"
#include "apps/editor/icons.h"
#include "apps/editor/theme.h"
#include "apps/editor/widgets.h"
#include "engine/geometry/error.h"
#include "engine/io/frame_pattern.h"

namespace sinew::editor {

namespace fs = std::filesystem;

namespace {

constexpr std::size_t most_notes = 4;

/// "walk.####.obj", where there are such files.
bool is_run(const std::string& path) {
  try {
    const std::optional<io::FramePattern> pattern = io::frame_pattern(path);
    return pattern && !io::frames_on_disk(*pattern).empty();
  } catch (const InputError&) {
    return false;
  }
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string absolute(const std::string& path) {
  std::error_code error;
  const fs::path whole = fs::weakly_canonical(path.empty() ? "." : path, error);
  return error ? path : whole.string();
}

}  // namespace

std::string size_text(std::uintmax_t bytes) {
  const char* units[] = {"B", "kB", "MB", "GB", "TB"};
  double value = static_cast<double>(bytes);
  std::size_t unit = 0;
  for (; value >= 999.5 && unit + 1 < std::size(units); ++unit) value /= 1000;
  return fmt::format("{:.{}f} {}", value, unit == 0 || value >= 99.95 ? 0 : 1, units[unit]);
}

void FileDialog::open(FileRequest request) {
  request_ = std::move(request);
  shown_ = just_opened_ = true;
  ask_again_ = close_ = false;
  filter_.clear();
  name_.clear();
  looked_at_.clear();
  changes_.clear();
  std::error_code error;
  const fs::path start = absolute(request_.start);
  if (fs::is_directory(start, error)) {
    enter(start.string());
  } else {
    name_ = start.filename().string();
    enter(fs::is_directory(start.parent_path(), error) ? start.parent_path().string() : absolute("."));
  }
}

void FileDialog::enter(const std::string& folder) {
  folder_ = typed_folder_ = folder;
  chosen_ = -1;
  ask_again_ = false;
  list_folder();
}

void FileDialog::list_folder() {
  entries_.clear();
  error_.clear();
  std::error_code error;
  fs::directory_iterator it(folder_, error), end;
  if (error) error_ = folder_ + ": " + error.message();
  for (; !error && it != end; it.increment(error)) {
    Entry entry;
    entry.name = it->path().filename().string();
    if (entry.name.starts_with('.')) continue;
    struct stat status {};
    if (stat(it->path().c_str(), &status) != 0) continue;
    entry.folder = S_ISDIR(status.st_mode);
    entry.size = static_cast<std::uintmax_t>(status.st_size);
    entry.date = fmt::format("{:%Y-%m-%d %H:%M}", fmt::localtime(status.st_mtime));
    entries_.push_back(std::move(entry));
  }
  std::sort(entries_.begin(), entries_.end(), [](const Entry& a, const Entry& b) {
    return a.folder != b.folder ? a.folder : lower(a.name) < lower(b.name);
  });
}

bool FileDialog::listed(const Entry& entry) const {
  const std::string name = lower(entry.name);
  if (!filter_.empty() && name.find(lower(filter_)) == std::string::npos) return false;
  if (entry.folder || request_.extensions.empty()) return true;
  return std::any_of(request_.extensions.begin(), request_.extensions.end(),
                     [&](const std::string& extension) { return name.ends_with("." + extension); });
}

void FileDialog::take(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) {
    enter(absolute(path));
    return;
  }
  if (request_.save && fs::exists(path, error) && !ask_again_) {
    ask_again_ = true;
    return;
  }
  if (!request_.save && !fs::exists(path, error) && !is_run(path)) {
    error_ = path + ": expected a file, found none";
    return;
  }
  close_ = true;
  request_.done(path);
}

void FileDialog::choose() {
  if (request_.save) {
    if (name_.empty()) return;
    take((fs::path(folder_) / name_).string());
  } else if (chosen_ >= 0 && chosen_ < static_cast<int>(entries_.size())) {
    take((fs::path(folder_) / entries_[static_cast<std::size_t>(chosen_)].name).string());
  }
}

/// The sentences above the buttons: what went wrong, else what the file would not hold, else the request's own.
std::vector<std::string> FileDialog::notes() {
  if (std::optional<Background::Outcome> outcome = looking_.take(); outcome && outcome->finish) outcome->finish();
  if (!error_.empty()) return {error_};
  if (request_.changes) {
    const bool frames = name_.find_first_of("#@%") != std::string::npos;
    const std::string ending = lower(fs::path(name_).extension().string()) + (frames ? "#" : "");
    if (ending != looked_at_ && !looking_.busy()) {
      looked_at_ = ending;
      looking_.start("Looking at the format", false,
                     [this, path = (fs::path(folder_) / name_).string(),
                      changes = request_.changes](const Tell&) -> Background::Finish {
                       auto found = std::make_shared<std::vector<std::string>>(changes(path));
                       return [this, found] { changes_ = std::move(*found); };
                     });
    }
    if (!changes_.empty()) return changes_;
  }
  return request_.note.empty() ? std::vector<std::string>{} : std::vector{request_.note};
}

void FileDialog::show(std::span<const std::string> recent) {
  if (!shown_) return;
  if (just_opened_) ImGui::OpenPopup("files");
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const ImVec2 size{std::min(px(760), display.x - px(32)), std::min(px(500), display.y - px(32))};
  ImGui::SetNextWindowPos({std::round(0.5f * (display.x - size.x)), std::round(0.5f * (display.y - size.y))});
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(16), px(12)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(6));
  const bool open = ImGui::BeginPopupModal(
      "files", nullptr, ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove);
  ImGui::PopStyleVar(2);
  if (!open) return;
  show_head();
  std::vector<std::string> sentences = notes();
  if (sentences.size() > most_notes) {
    const std::size_t more = sentences.size() - most_notes + 1;
    sentences.resize(most_notes - 1);
    sentences.push_back("and " + std::to_string(more) + " more");
  }
  const float foot = px(28 + 12) + px(request_.save ? 32 : 0) + px(24) * static_cast<float>(sentences.size());
  const float height = ImGui::GetContentRegionAvail().y - foot;
  if (!request_.save && !recent.empty()) {
    show_recent(recent, px(200), height);
    ImGui::SameLine(0, px(12));
  }
  show_entries(height);
  show_foot(sentences);
  if (close_) {
    shown_ = false;
    ImGui::CloseCurrentPopup();
  }
  just_opened_ = false;
  ImGui::EndPopup();
}

void FileDialog::show_head() {
  ImGui::PushFont(fonts().bold);
  ImGui::TextUnformatted(request_.title.c_str());
  ImGui::PopFont();
  const float filter_width = px(180);
  if (widget::icon_button(icon::up, "up", false, px(measure::row), theme().quiet, "The folder above"))
    enter(fs::path(folder_).parent_path().string());
  ImGui::SameLine(0, px(4));
  if (widget::icon_button(icon::home, "home", false, px(measure::row), theme().quiet, "Your folder")) {
    const char* home = std::getenv("HOME");
    if (home != nullptr) enter(home);
  }
  ImGui::SameLine(0, px(8));
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - filter_width - px(8));
  if (ImGui::InputText("##folder", &typed_folder_, ImGuiInputTextFlags_EnterReturnsTrue)) take(typed_folder_);
  ImGui::SameLine(0, px(8));
  ImGui::SetNextItemWidth(filter_width);
  if (just_opened_ && !request_.save) ImGui::SetKeyboardFocusHere();
  if (ImGui::InputTextWithHint("##filter", "Filter", &filter_)) {
    chosen_ = -1;
    for (std::size_t i = 0; i < entries_.size() && chosen_ < 0; ++i)
      if (listed(entries_[i])) chosen_ = static_cast<int>(i);
  }
  ImGui::Dummy({0, px(4)});
}

void FileDialog::show_recent(std::span<const std::string> recent, float width, float height) {
  ImGui::BeginChild("recent", {width, height});
  widget::heading("RECENT", true);
  for (const std::string& path : recent) {
    ImGui::PushID(path.c_str());
    const ImVec2 at = ImGui::GetCursorPos();
    const bool pressed = ImGui::Selectable("##file", false, 0, {0, px(measure::row)});
    if (ImGui::IsItemHovered()) widget::tooltip(path);
    const ImVec2 after = ImGui::GetCursorPos();
    ImGui::SetCursorPos({at.x + px(4), at.y + std::round(0.5f * (px(measure::row) - ImGui::GetFontSize()))});
    widget::text_cut(fs::path(path).filename().string(), width - px(12), theme().text);
    ImGui::SetCursorPos(after);
    ImGui::PopID();
    if (pressed) take(path);
  }
  ImGui::EndChild();
}

void FileDialog::show_entries(float height) {
  ImGui::PushStyleColor(ImGuiCol_ChildBg, theme().field);
  ImGui::PushStyleVar(ImGuiStyleVar_ChildRounding, px(4));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(4), px(4)));
  ImGui::BeginChild("entries", {0, height}, false, ImGuiWindowFlags_AlwaysUseWindowPadding);
  const float width = ImGui::GetContentRegionAvail().x, row = px(measure::row);
  const float date_width = ImGui::CalcTextSize("2026-00-00 00:00").x, size_width = px(72);
  ImDrawList* list = ImGui::GetWindowDrawList();
  std::string entered, taken;
  bool any = false;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    if (!listed(entry)) continue;
    any = true;
    ImGui::PushID(static_cast<int>(i));
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ImGui::Selectable("##entry", chosen_ == static_cast<int>(i), ImGuiSelectableFlags_AllowDoubleClick, {0, row})) {
      chosen_ = static_cast<int>(i);
      ask_again_ = false;
      if (!entry.folder) name_ = entry.name;
      const std::string path = (fs::path(folder_) / entry.name).string();
      if (ImGui::IsMouseDoubleClicked(0)) (entry.folder ? entered : taken) = path;
    }
    ImGui::PopID();
    const float y = at.y + std::round(0.5f * (row - ImGui::GetFontSize()));
    widget::text_at(list, ImGui::GetFont(), {at.x + px(4), y}, entry.folder ? theme().accent : theme().faint,
                    entry.folder ? icon::folder : icon::file);
    const float name_width = width - date_width - size_width - px(24 + 16);
    widget::text_at(list, ImGui::GetFont(), {at.x + px(24), y}, theme().text, widget::cut(entry.name, name_width));
    if (!entry.folder) {
      const std::string size = size_text(entry.size);
      widget::text_at(list, ImGui::GetFont(),
                      {at.x + width - date_width - px(16) - ImGui::CalcTextSize(size.c_str()).x, y}, theme().faint,
                      size);
    }
    widget::text_at(list, ImGui::GetFont(), {at.x + width - date_width - px(4), y}, theme().faint, entry.date);
  }
  if (!any) ImGui::TextDisabled(entries_.empty() ? "Nothing is in this folder." : "Nothing here that can be opened.");
  ImGui::EndChild();
  ImGui::PopStyleVar(2);
  ImGui::PopStyleColor();
  if (!entered.empty()) enter(entered);
  if (!taken.empty()) take(taken);
}

void FileDialog::show_foot(std::span<const std::string> sentences) {
  ImGui::Dummy({0, px(4)});
  const bool warns = !error_.empty() || !changes_.empty();
  for (const std::string& sentence : sentences) {
    const ImVec2 at = ImGui::GetCursorPos();
    widget::text_cut(sentence, ImGui::GetContentRegionAvail().x, warns ? theme().warning : theme().quiet);
    ImGui::SetCursorPos({at.x, at.y + px(24)});
  }
  if (request_.save) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted("Name");
    ImGui::SameLine(0, px(12));
    ImGui::SetNextItemWidth(-FLT_MIN);
    if (just_opened_) ImGui::SetKeyboardFocusHere();
    if (ImGui::InputText("##name", &name_)) ask_again_ = false;
  }
  const bool can = request_.save ? !name_.empty() : chosen_ >= 0;
  const std::string action = ask_again_ ? "Replace " + name_ : request_.action;
  const float action_width = std::round(ImGui::CalcTextSize(action.c_str()).x) + px(32);
  const float cancel_width = std::round(ImGui::CalcTextSize("Cancel").x) + px(32);
  if (!request_.folder_action.empty()) {
    if (widget::button(request_.folder_action.c_str(), false)) {
      const auto row = static_cast<std::size_t>(chosen_);
      const bool inside = chosen_ >= 0 && row < entries_.size() && entries_[row].folder;
      close_ = true;
      request_.done(inside ? (fs::path(folder_) / entries_[row].name).string() : folder_);
    }
    if (ImGui::IsItemHovered()) widget::tooltip(request_.folder_help);
    ImGui::SameLine();
  }
  ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - action_width - cancel_width - px(8));
  if (widget::button("Cancel", false) || ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false)) close_ = true;
  ImGui::SameLine(0, px(8));
  ImGui::BeginDisabled(!can);
  if (widget::button(action.c_str(), true)) choose();
  ImGui::EndDisabled();
  if (can && !just_opened_ &&
      (ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Enter), false) ||
       ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_KeyPadEnter), false)))
    choose();
}

}  // namespace sinew::editor
