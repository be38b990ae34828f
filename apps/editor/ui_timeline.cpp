#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/editor/gui.h"
#include "apps/editor/icons.h"
#include "apps/editor/theme.h"
#include "apps/editor/ui.h"
#include "apps/editor/widgets.h"

namespace sinew::editor {

namespace {

/// The track of frames: where it is, and which frames its ends are.
struct Track {
  float left = 0, right = 0, top = 0, bottom = 0;
  int first = 1, last = 1;

  float x(double frame) const {
    const double share = last > first ? (frame - first) / (last - first) : 0;
    return left + static_cast<float>(share) * (right - left);
  }
  int frame(float at) const {
    const double share = std::clamp((at - left) / std::max(1.0F, right - left), 0.0F, 1.0F);
    return first + static_cast<int>(std::lround(share * (last - first)));
  }
};

/// 1, 2, 5, 10, 20 ...: the distance of ticks that leaves room for their numbers.
int tick_step(const Track& track) {
  const float room =
      px(48) / std::max(1e-3F, (track.right - track.left) / static_cast<float>(std::max(1, track.last - track.first)));
  for (int power = 1;; power *= 10)
    for (const int digit : {1, 2, 5})
      if (static_cast<float>(power * digit) >= room) return power * digit;
}

void show_buttons(Ui& ui, ImVec2 at) {
  struct Row {
    const char* command;
    const char* icon;
  };
  const bool playing = ui.context.session.playing();
  const std::array<Row, 5> rows{{{"time.former_key", icon::to_start},
                                 {"time.back", icon::step_back},
                                 {"time.play", playing ? icon::pause : icon::play},
                                 {"time.forward", icon::step_forward},
                                 {"time.next_key", icon::to_end}}};
  const float side = px(28);
  ImGui::SetCursorScreenPos(at);
  for (const Row& row : rows) {
    command_button(ui, row.command, row.icon, side, theme().text, playing && row.command == rows[2].command);
    ImGui::SameLine(0, px(2));
  }
}

/// "12 / 48", the first part to be typed or dragged.
void show_number(Ui& ui, ImVec2 at, float width) {
  Session& session = ui.context.session;
  ImGui::SetCursorScreenPos(at);
  ImGui::SetNextItemWidth(width);
  double frame = session.wanted_frame();
  const widget::Number described{static_cast<double>(session.frames().front()),
                                 static_cast<double>(session.frames().back()), true, false, ""};
  if (widget::number("##frame", frame, described)) session.go_to_frame(static_cast<int>(frame));
  if (ImGui::IsItemHovered()) widget::tooltip("Frame");
}

/// Half the width of the flag at the frame shown.
float flag_half(int frame) {
  return 0.5F * widget::size_of(fonts().bold, std::to_string(frame)).x + px(5);
}

/// What is played is lighter; the ends of the range can be dragged.
void show_range(Ui& ui, ImDrawList* list, const Track& track) {
  Session& session = ui.context.session;
  const auto [begin, end] = session.play_range();
  if (begin != track.first || end != track.last)
    list->AddRectFilled({std::round(track.x(begin)), track.top}, {std::round(track.x(end)), track.bottom},
                        packed(theme().chosen));
  for (const bool first : {true, false}) {
    const int frame = first ? begin : end;
    if (frame == (first ? track.first : track.last)) continue;
    const float x = std::round(track.x(frame));
    list->AddLine({x, track.top}, {x, track.bottom}, packed(theme().quiet), px(2));
    ImGui::PushID(first ? "begin" : "end");
    ImGui::SetCursorScreenPos({x - px(5), track.bottom - px(8)});
    ImGui::InvisibleButton("edge", {px(10), px(8)});
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
      ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
      if (!ImGui::IsItemActive()) widget::tooltip(first ? "Playing begins here" : "Playing ends here");
    }
    if (ImGui::IsItemActive()) {
      const int to = track.frame(ImGui::GetMousePos().x);
      if (first && to < end) session.set_play_range(std::pair(to, end));
      if (!first && to > begin) session.set_play_range(std::pair(begin, to));
    }
    ImGui::PopID();
  }
}

/// `shown`: the frame whose flag covers what is below it.
void draw_ticks(ImDrawList* list, const Track& track, int shown) {
  const int step = tick_step(track);
  const float middle = track.bottom - px(20);
  for (int frame = (track.first + step - 1) / step * step; frame <= track.last; frame += step) {
    const float x = std::round(track.x(frame));
    list->AddLine({x, middle}, {x, middle + px(5)}, packed(theme().faint));
    const std::string text = std::to_string(frame);
    const ImVec2 size = widget::size_of(fonts().text, text);
    if (std::abs(x - track.x(shown)) < flag_half(shown) + 0.5F * size.x + px(2)) continue;
    widget::text_at(list, fonts().text, {x - 0.5F * size.x, track.top + px(3)}, theme().faint, text);
  }
}

void key_menu(Session& session, const document::Key& key) {
  static constexpr std::array names = {"Linear to the next key", "Smooth to the next key", "Hold until the next key"};
  ImGui::TextDisabled("Key at %d", key.frame);
  for (std::size_t i = 0; i < names.size(); ++i)
    if (ImGui::MenuItem(names[i], nullptr, static_cast<std::size_t>(key.interpolation) == i))
      session.set_interpolation(key.frame, static_cast<document::Interpolation>(i));
  ImGui::Separator();
  if (ImGui::MenuItem("Delete key", "Alt+I")) session.delete_key(key.frame);
}

/// A diamond; of a held key its right half is square.
void draw_key(ImDrawList* list, ImVec2 at, float radius, ImU32 color, document::Interpolation interpolation) {
  const float r = radius;
  if (interpolation == document::Interpolation::Smooth) {
    list->AddCircleFilled(at, r * 0.9F, color, 16);
    return;
  }
  list->AddQuadFilled({at.x - r, at.y}, {at.x, at.y - r}, {at.x + r, at.y}, {at.x, at.y + r}, color);
  if (interpolation == document::Interpolation::Hold)
    list->AddRectFilled({at.x, at.y - r}, {at.x + r, at.y + r}, color);
}

void show_keys(Ui& ui, ImDrawList* list, const Track& track) {
  Session& session = ui.context.session;
  if (session.layer() == nullptr) return;
  const float y = track.bottom - px(9), radius = px(5);
  const std::vector<document::Key> keys = session.layer()->keys;
  for (const document::Key& key : keys) {
    if (key.frame < track.first || key.frame > track.last) continue;
    ImGui::PushID(key.frame);
    float x = track.x(key.frame);
    ImGui::SetCursorScreenPos({x - px(8), y - px(8)});
    const bool pressed = ImGui::InvisibleButton("key", {px(16), px(16)});
    const bool hovered = ImGui::IsItemHovered();
    if (ImGui::BeginPopupContextItem("key menu")) {
      key_menu(session, key);
      ImGui::EndPopup();
    }
    if (ImGui::IsItemActive() && ImGui::IsMouseDragging(0, px(3))) {
      ui.moved_key = key.frame;
      ui.moved_key_to = track.frame(ImGui::GetMousePos().x);
    } else if (pressed && ui.moved_key != key.frame) {
      session.go_to_frame(key.frame);
    }
    if (ui.moved_key == key.frame) x = track.x(ui.moved_key_to);
    const bool here = key.frame == session.wanted_frame();
    draw_key(list, {x, y}, radius, packed(here || hovered ? theme().text : theme().handle), key.interpolation);
    if (hovered && !ImGui::IsMouseDragging(0)) {
      // Above the timeline, where it covers no other key.
      const std::string help = fmt::format("Key at {}: drag to move, right click for more", key.frame);
      const float half = 0.5F * widget::size_of(fonts().text, help).x + px(16);
      const float middle = std::max(half, std::min(x, ui.layout.width - half));
      ImGui::SetNextWindowPos({std::round(middle), track.top - px(12)}, ImGuiCond_Always, {0.5F, 1});
      widget::tooltip(help);
    }
    ImGui::PopID();
  }
  if (ui.moved_key && !ImGui::IsMouseDown(0)) {
    session.move_key(*ui.moved_key, ui.moved_key_to);
    ui.moved_key.reset();
  }
}

/// The line at the frame shown, with its number in a flag.
void draw_head(ImDrawList* list, const Track& track, int frame, bool late) {
  const float x = std::round(track.x(frame));
  const ImU32 color = packed(theme().accent, late ? 0.6F : 1.0F);
  list->AddLine({x, track.top}, {x, track.bottom}, color, px(2));
  const std::string text = std::to_string(frame);
  const ImVec2 size = widget::size_of(fonts().bold, text);
  const float half = flag_half(frame);
  const float middle = std::clamp(x, track.left - px(8) + half, track.right + px(8) - half);
  list->AddRectFilled({middle - half, track.top}, {middle + half, track.top + px(18)}, color, px(3));
  widget::text_at(list, fonts().bold, {middle - 0.5F * size.x, track.top + 0.5F * (px(18) - size.y)}, theme().on_accent,
                  text);
}

/// A press anywhere on the track goes there, and so does a drag.
void scrub(Session& session, const Track& track) {
  ImGui::SetCursorScreenPos({track.left - px(8), track.top});
  ImGui::InvisibleButton("track", {track.right - track.left + px(16), track.bottom - track.top});
  ImGui::SetItemAllowOverlap();
  if (!ImGui::IsItemActive()) return;
  if (session.playing()) session.play(false);
  session.go_to_frame(track.frame(ImGui::GetMousePos().x));
}

}  // namespace

float timeline_height(const Ui& ui) {
  return ui.context.session.moves() ? px(measure::timeline) : 0;
}

void show_timeline(Ui& ui) {
  Session& session = ui.context.session;
  if (!session.moves()) return;
  const float height = timeline_height(ui), top = ui.layout.bottom;
  widget::begin_panel("timeline", {0, top}, {ui.layout.width, height});
  const float pad = px(measure::pad), row = top + 0.5F * (height - px(28));
  show_buttons(ui, {pad, row});
  show_number(ui, {pad + px(162), row + px(2)}, px(64));
  const std::string rate = fmt::format("of {} · {:g} fps", session.frames().back(), session.rate());
  const ImVec2 size = widget::size_of(fonts().text, rate);
  ImDrawList* list = ImGui::GetWindowDrawList();
  widget::text_at(list, fonts().text, {pad + px(234), top + 0.5F * (height - size.y)}, theme().quiet, rate);

  Track track;
  track.left = pad + px(234) + size.x + px(28);
  track.right = ui.layout.width - pad - px(44);
  track.top = top + px(8);
  track.bottom = top + height - px(8);
  track.first = session.frames().front();
  track.last = session.frames().back();
  scrub(session, track);
  list->AddRectFilled({track.left - px(8), track.top}, {track.right + px(8), track.bottom}, packed(theme().field),
                      px(4));
  show_range(ui, list, track);
  draw_ticks(list, track, session.wanted_frame());
  draw_head(list, track, session.wanted_frame(), !session.playing() && session.wanted_frame() != session.frame());
  show_keys(ui, list, track);
  ImGui::SetCursorScreenPos({ui.layout.width - pad - px(28), row});
  command_button(ui, "time.key", icon::key, px(28), theme().handle, false);
  widget::edge_line({0, 0}, {1, 0});
  ImGui::End();
  const double next = session.next_step();
  if (next >= 0) ui.next_frame = std::min(ui.next_frame, now() + next);
}

}  // namespace sinew::editor
