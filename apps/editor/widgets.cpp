#include "apps/editor/widgets.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>

#include "apps/editor/gui.h"
#include "apps/editor/icons.h"
#include "apps/editor/theme.h"

namespace sinew::editor::widget {

bool begin_panel(const char* name, ImVec2 position, ImVec2 size, ImGuiWindowFlags more) {
  ImGui::SetNextWindowPos(position);
  ImGui::SetNextWindowSize(size);
  return ImGui::Begin(name, nullptr,
                      ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                          ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav | more);
}

void edge_line(ImVec2 from, ImVec2 to) {
  const ImVec2 at = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  const float width = px(1);
  ImVec2 a{at.x + from.x * size.x, at.y + from.y * size.y}, b{at.x + to.x * size.x, at.y + to.y * size.y};
  if (a.y == b.y) {
    if (from.y == 1) a.y -= width;
    b.y = a.y + width;
  } else {
    if (from.x == 1) a.x -= width;
    b.x = a.x + width;
  }
  ImDrawList* list = ImGui::GetWindowDrawList();
  list->PushClipRectFullScreen();
  list->AddRectFilled(a, b, packed(theme().line));
  list->PopClipRect();
}

ImVec2 size_of(ImFont* font, const std::string& text) {
  return font->CalcTextSizeA(font->FontSize, FLT_MAX, 0, text.data(), text.data() + text.size());
}

void text_at(ImDrawList* list, ImFont* font, ImVec2 at, const ImVec4& color, const std::string& text) {
  list->AddText(font, font->FontSize, {std::round(at.x), std::round(at.y)}, packed(color), text.data(),
                text.data() + text.size());
}

std::string cut(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  std::string shorter = text;
  while (!shorter.empty()) {
    do shorter.pop_back();
    while (!shorter.empty() && (static_cast<unsigned char>(shorter.back()) & 0xc0) == 0x80);
    if (!shorter.empty() && static_cast<unsigned char>(shorter.back()) >= 0xc0) shorter.pop_back();
    if (ImGui::CalcTextSize((shorter + "…").c_str()).x <= width) break;
  }
  return shorter + "…";
}

void text_cut(const std::string& text, float width, const ImVec4& color) {
  const std::string shown = cut(text, width);
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::TextUnformatted(shown.c_str());
  ImGui::PopStyleColor();
  if (shown != text && ImGui::IsItemHovered()) tooltip(text);
}

void heading(const std::string& text, bool first) {
  ImGui::Dummy({0, px(first ? 2 : 8)});
  ImGui::PushFont(fonts().small);
  const float height = px(measure::row) - px(measure::gap);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  text_at(ImGui::GetWindowDrawList(), fonts().small, {at.x, at.y + 0.5f * (height - fonts().small->FontSize)},
          theme().quiet, cut(text, ImGui::GetContentRegionAvail().x));
  ImGui::PopFont();
  ImGui::Dummy({0, height});
}

void label(const std::string& text, const std::string& help) {
  const float left = ImGui::GetCursorPosX();
  ImGui::AlignTextToFramePadding();
  text_cut(text, px(measure::label_column) - px(8), theme().quiet);
  if (!help.empty() && ImGui::IsItemHovered()) tooltip(help);
  ImGui::SameLine(left + px(measure::label_column));
  ImGui::SetNextItemWidth(-FLT_MIN);
}

void value_right(const std::string& value, const ImVec4& color) {
  const float width = ImGui::CalcTextSize(value.c_str()).x;
  ImGui::SameLine();
  ImGui::SetCursorPosX(ImGui::GetWindowContentRegionMax().x - width);
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::TextUnformatted(value.c_str());
  ImGui::PopStyleColor();
}

namespace {

/// The edge of a field: brighter under the mouse, accented while it is typed into.
void field_edge() {
  const ImVec4 color = ImGui::IsItemActive() ? theme().accent : ImGui::IsItemHovered() ? theme().chosen : theme().line;
  ImGui::GetWindowDrawList()->AddRect(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(), packed(color),
                                      ImGui::GetStyle().FrameRounding, 0, px(1));
}

void right_inside(const std::string& text, const ImVec4& color) {
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  text_at(ImGui::GetWindowDrawList(), ImGui::GetFont(), {max.x - size.x - px(8), 0.5f * (min.y + max.y - size.y)},
          color, text);
}

}  // namespace

void push_fields() {
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(px(8), std::floor(0.5f * (px(20) - ImGui::GetFontSize()))));
  ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(px(8), px(4)));
}

void pop_fields() {
  ImGui::PopStyleVar(2);
}

bool number(const char* id, double& value, const Number& described) {
  ImGuiSliderFlags flags = ImGuiSliderFlags_AlwaysClamp;
  if (described.logarithmic) flags |= ImGuiSliderFlags_Logarithmic;
  char format[8] = "%.0f";
  if (!described.integer) ImFormatString(format, sizeof format, "%%.%dg", described.digits);
  const double range = described.max - described.min;
  const double speed = described.speed > 0 ? described.speed
                       : described.integer ? std::max(0.05, std::min(range, 2 * std::abs(value) + 10) / 300)
                                           : std::min(range, 2 * std::abs(value) + 1e-3) / 300;
  // Its own text is centred: while it is not typed into, the number is drawn here, at the left.
  const bool typed = ImGui::TempInputIsActive(ImGui::GetID(id));
  if (!typed) ImGui::PushStyleColor(ImGuiCol_Text, ImVec4(0, 0, 0, 0));
  ImGui::DragScalar(id, ImGuiDataType_Double, &value, static_cast<float>(speed), &described.min, &described.max, format,
                    flags);
  if (!typed) ImGui::PopStyleColor();
  if (described.integer) value = std::round(value);
  field_edge();
  const bool done = ImGui::IsItemDeactivatedAfterEdit();
  if (ImGui::IsItemHovered()) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (typed) return done;
  char text[64];
  ImFormatString(text, sizeof text, format, value);
  const ImVec2 min = ImGui::GetItemRectMin(), max = ImGui::GetItemRectMax();
  text_at(ImGui::GetWindowDrawList(), ImGui::GetFont(), {min.x + px(8), 0.5f * (min.y + max.y - ImGui::GetFontSize())},
          theme().text, text);
  if (described.unit[0] != 0) right_inside(described.unit, theme().faint);
  return done;
}

bool choice(const char* id, std::size_t& chosen, std::span<const std::string> names) {
  bool changed = false;
  const std::string none;
  const std::string& shown = chosen < names.size() ? names[chosen] : none;
  const float room = ImGui::CalcItemWidth() - px(32);
  const bool open =
      ImGui::BeginCombo(id, cut(shown, room).c_str(), ImGuiComboFlags_NoArrowButton | ImGuiComboFlags_HeightLarge);
  if (open) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (ImGui::Selectable(names[i].c_str(), i == chosen)) {
        changed = i != chosen;
        chosen = i;
      }
    }
    ImGui::EndCombo();
  }
  field_edge();
  right_inside(icon::chevron_down, theme().quiet);
  return changed;
}

bool checkbox(const char* id, bool& on) {
  const float side = px(16);
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float top = at.y + std::round(0.5f * (ImGui::GetFrameHeight() - side));
  const bool pressed = ImGui::InvisibleButton(id, {side, ImGui::GetFrameHeight()});
  if (pressed) on = !on;
  ImDrawList* list = ImGui::GetWindowDrawList();
  const ImVec2 min{at.x, top}, max{at.x + side, top + side};
  list->AddRectFilled(min, max, packed(on ? theme().accent : theme().field), px(3));
  list->AddRect(min, max,
                packed(on                       ? theme().accent
                       : ImGui::IsItemHovered() ? theme().quiet
                                                : theme().line),
                px(3), 0, px(1));
  if (on) {
    const ImVec2 size = size_of(fonts().small, icon::check);
    text_at(list, fonts().small, {0.5f * (min.x + max.x - size.x), 0.5f * (min.y + max.y - size.y)}, theme().on_accent,
            icon::check);
  }
  return pressed;
}

bool slider(const char* id, float& value, float min, float max, const char* format) {
  const float width = ImGui::CalcItemWidth(), height = ImGui::GetFrameHeight();
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::InvisibleButton(id, {width, height});
  const bool active = ImGui::IsItemActive();
  if (active) value = min + (max - min) * std::clamp((ImGui::GetIO().MousePos.x - at.x) / width, 0.0f, 1.0f);
  ImDrawList* list = ImGui::GetWindowDrawList();
  const float rounding = ImGui::GetStyle().FrameRounding;
  list->AddRectFilled(at, {at.x + width, at.y + height}, packed(theme().field), rounding);
  const float part = std::clamp((value - min) / (max - min), 0.0f, 1.0f);
  list->AddRectFilled(at, {at.x + std::max(rounding * 2, std::round(part * width)), at.y + height},
                      packed(theme().chosen), rounding);
  field_edge();
  char text[32];
  ImFormatString(text, sizeof text, format, static_cast<double>(value));
  text_at(list, ImGui::GetFont(), {at.x + px(8), at.y + 0.5f * (height - ImGui::GetFontSize())}, theme().text, text);
  return active;
}

BarUse bar(const char* id, double& value, double min, double max, bool lit) {
  const bool typed = ImGui::TempInputIsActive(ImGui::GetID(id));
  const ImVec4 unseen(0, 0, 0, 0);
  ImGui::PushStyleColor(ImGuiCol_SliderGrab, unseen);
  ImGui::PushStyleColor(ImGuiCol_SliderGrabActive, unseen);
  if (!typed) ImGui::PushStyleColor(ImGuiCol_Text, unseen);
  ImGui::PushStyleVar(ImGuiStyleVar_GrabMinSize, 1);
  BarUse out;
  out.changed = ImGui::SliderScalar(id, ImGuiDataType_Double, &value, &min, &max, "%.2f");
  ImGui::PopStyleVar();
  ImGui::PopStyleColor(typed ? 2 : 3);
  out.begun = ImGui::IsItemActivated();
  out.ended = ImGui::IsItemDeactivated();
  out.cancelled = ImGui::IsItemActive() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false);
  if (out.cancelled && !typed) ImGui::ClearActiveID();
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  if (!typed) {
    const auto place = [&](double at) {
      const double part = std::clamp((at - min) / (max - min), 0.0, 1.0);
      return std::round(from.x + px(1) + static_cast<float>(part) * (to.x - from.x - px(2)));
    };
    ImDrawList* list = ImGui::GetWindowDrawList();
    const float zero = place(0), end = place(value), edge = px(1);
    list->AddRectFilled({std::min(zero, end), from.y + edge}, {std::max(zero, end), to.y - edge},
                        packed(lit ? theme().accent : theme().quiet, lit ? 0.55f : 0.35f));
    char text[32];
    ImFormatString(text, sizeof text, "%.2f", std::abs(value) < 0.005 ? 0 : value);
    const float digits = to.x - px(8) - ImGui::CalcTextSize(text).x;
    for (const double mark : {0.0, 1.0}) {
      const float x = place(mark);
      if (x + edge > digits - px(2)) continue;
      list->AddRectFilled({x, to.y - px(4)}, {x + edge, to.y - edge}, packed(theme().quiet));
    }
    right_inside(text, theme().text);
  }
  field_edge();
  return out;
}

bool icon_button(const char* icon, const char* id, bool chosen, float side, const ImVec4& color,
                 const std::string& help, const std::string& shortcut) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const bool pressed = ImGui::InvisibleButton(id, {side, side});
  const bool hovered = ImGui::IsItemHovered();
  ImDrawList* list = ImGui::GetWindowDrawList();
  if (chosen || hovered)
    list->AddRectFilled(at, {at.x + side, at.y + side}, packed(chosen ? theme().chosen : theme().hover), px(4));
  ImFont* font = fonts().icons;
  const ImVec2 size = size_of(font, icon);
  const bool enabled = (ImGui::GetItemFlags() & ImGuiItemFlags_Disabled) == 0;
  ImVec4 shown = color;
  if (!enabled) shown.w *= 0.35f;
  text_at(list, font, {at.x + 0.5f * (side - size.x), at.y + 0.5f * (side - size.y)}, shown, icon);
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) tooltip(help, shortcut);
  return pressed;
}

int switch_of(const char* id, std::span<const char* const> names, int chosen, std::span<const char* const> help) {
  ImGui::PushID(id);
  int pressed = -1;
  const float height = px(measure::row);
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) ImGui::SameLine(0, 0);
    const ImVec2 size = ImGui::CalcTextSize(names[i]);
    const float width = std::round(size.x) + px(18);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const bool on = static_cast<int>(i) == chosen;
    if (ImGui::InvisibleButton(names[i], {width, height}) && !on) pressed = static_cast<int>(i);
    ImDrawList* list = ImGui::GetWindowDrawList();
    if (on) list->AddRectFilled(at, {at.x + width, at.y + height}, packed(theme().chosen), px(4));
    text_at(list, ImGui::GetFont(), {at.x + px(9), at.y + 0.5f * (height - size.y)},
            on || ImGui::IsItemHovered() ? theme().text : theme().quiet, names[i]);
    if (i < help.size() && ImGui::IsItemHovered()) tooltip(help[i]);
  }
  ImGui::PopID();
  return pressed;
}

bool button(const char* text, bool primary, float width) {
  const ImVec4& base = primary ? theme().accent : theme().chosen;
  ImGui::PushStyleColor(ImGuiCol_Button, base);
  ImGui::PushStyleColor(ImGuiCol_ButtonHovered, {base.x * 1.08f, base.y * 1.08f, base.z * 1.08f, base.w});
  ImGui::PushStyleColor(ImGuiCol_ButtonActive, {base.x * 0.92f, base.y * 0.92f, base.z * 0.92f, base.w});
  ImGui::PushStyleColor(ImGuiCol_Text, primary ? theme().on_accent : theme().text);
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 0);
  const float needed = std::round(ImGui::CalcTextSize(text, nullptr, true).x) + px(32);
  const bool pressed = ImGui::Button(text, {std::max(width, needed), px(28)});
  ImGui::PopStyleVar();
  ImGui::PopStyleColor(4);
  return pressed;
}

bool begin_dialog(bool& shown, const char* id, float width, float height) {
  if (!shown) return false;
  if (!ImGui::IsPopupOpen(id)) ImGui::OpenPopup(id);
  const ImVec2 display = ImGui::GetIO().DisplaySize;
  const ImVec2 size{std::min(px(width), display.x - px(32)), std::min(px(height), display.y - px(48))};
  ImGui::SetNextWindowPos(
      {std::round(0.5f * (display.x - size.x)), std::round(std::max(px(32), 0.4f * (display.y - size.y)))});
  ImGui::SetNextWindowSize(size);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(12), px(12)));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, px(6));
  const bool open = ImGui::BeginPopupModal(
      id, nullptr,
      ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoNav);
  ImGui::PopStyleVar(2);
  if (open && ImGui::IsMouseClicked(0) &&
      !ImGui::IsWindowHovered(ImGuiHoveredFlags_RootAndChildWindows | ImGuiHoveredFlags_AllowWhenBlockedByActiveItem))
    shown = false;
  if (open && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Escape), false)) shown = false;
  return open;
}

void end_dialog(bool shown) {
  if (!shown) ImGui::CloseCurrentPopup();
  ImGui::EndPopup();
}

void tooltip(const std::string& text, const std::string& shortcut) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(px(8), px(5)));
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(px(320));
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  if (!shortcut.empty()) {
    ImGui::SameLine(0, px(12));
    ImGui::TextDisabled("%s", shortcut.c_str());
  }
  ImGui::EndTooltip();
  ImGui::PopStyleVar();
}

}  // namespace sinew::editor::widget
