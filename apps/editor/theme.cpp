#include "apps/editor/theme.h"

#include <algorithm>
#include <cmath>

#include "engine/gpu/solid.h"

namespace sinew::editor {

namespace {

ImVec4 rgb(unsigned hex, float opacity = 1) {
  return {static_cast<float>(hex >> 16 & 255) / 255.0f, static_cast<float>(hex >> 8 & 255) / 255.0f,
          static_cast<float>(hex & 255) / 255.0f, opacity};
}

const Theme* current = nullptr;
float current_scale = 1;

}  // namespace

const Theme& dark_theme() {
  static const Theme dark{.name = "Dark",
                          .panel = rgb(0x1c1f24, 0.94f),
                          .popup = rgb(0x22262c),
                          .field = rgb(0x15171b),
                          .line = rgb(0x2c3037),
                          .hover = rgb(0x2a2f37),
                          .chosen = rgb(0x323842),
                          .text = rgb(0xd6d9df),
                          .quiet = rgb(0xa9afb9),
                          .faint = rgb(0x868d99),
                          .accent = rgb(0x5b8def),
                          .on_accent = rgb(0xffffff),
                          .handle = rgb(0xf2932e),
                          .fixed = rgb(0x5b9bea),
                          .rigid = rgb(0xa47de0),
                          .axes = {rgb(0xe5534b), rgb(0x6cc24a), rgb(0x4c8fe8)},
                          .shade = rgb(0x0c0e11, 0.55f),
                          .warning = rgb(0xf0b44c),
                          .look = gpu::dark_look()};
  return dark;
}

const Theme& light_theme() {
  static const Theme light{.name = "Light",
                           .panel = rgb(0xfafbfc, 0.95f),
                           .popup = rgb(0xffffff),
                           .field = rgb(0xeceef1),
                           .line = rgb(0xd3d7dd),
                           .hover = rgb(0xe9ecf0),
                           .chosen = rgb(0xd9e1ee),
                           .text = rgb(0x1d2127),
                           .quiet = rgb(0x4a515c),
                           .faint = rgb(0x656d79),
                           .accent = rgb(0x2f6bd8),
                           .on_accent = rgb(0xffffff),
                           .handle = rgb(0xe07d12),
                           .fixed = rgb(0x2f7bd6),
                           .rigid = rgb(0x8455cf),
                           .axes = {rgb(0xd43d34), rgb(0x3f9a22), rgb(0x2a6fd0)},
                           .shade = rgb(0x3a4250, 0.35f),
                           .warning = rgb(0xa86200),
                           .look = gpu::light_look()};
  return light;
}

const Theme& theme() {
  return current != nullptr ? *current : dark_theme();
}

float scale() {
  return current_scale;
}

float px(float at_scale_1) {
  const float scaled = std::round(at_scale_1 * current_scale);
  return at_scale_1 > 0 ? std::max(1.0f, scaled) : scaled;
}

ImU32 packed(const ImVec4& color, float opacity) {
  return ImGui::ColorConvertFloat4ToU32({color.x, color.y, color.z, color.w * opacity});
}

namespace {

void set_colors(ImGuiStyle& style, const Theme& t) {
  ImVec4* c = style.Colors;
  const ImVec4 none{0, 0, 0, 0};
  for (int i = 0; i < ImGuiCol_COUNT; ++i) c[i] = t.line;
  c[ImGuiCol_Text] = t.text;
  c[ImGuiCol_TextDisabled] = t.faint;
  c[ImGuiCol_WindowBg] = t.panel;
  c[ImGuiCol_ChildBg] = none;
  c[ImGuiCol_PopupBg] = t.popup;
  c[ImGuiCol_BorderShadow] = none;
  c[ImGuiCol_FrameBg] = c[ImGuiCol_FrameBgHovered] = c[ImGuiCol_FrameBgActive] = t.field;
  c[ImGuiCol_MenuBarBg] = none;
  c[ImGuiCol_ScrollbarBg] = none;
  c[ImGuiCol_ScrollbarGrab] = t.line;
  c[ImGuiCol_ScrollbarGrabHovered] = c[ImGuiCol_ScrollbarGrabActive] = t.chosen;
  c[ImGuiCol_CheckMark] = c[ImGuiCol_SliderGrab] = c[ImGuiCol_SliderGrabActive] = t.accent;
  c[ImGuiCol_Button] = t.hover;
  c[ImGuiCol_ButtonHovered] = c[ImGuiCol_ButtonActive] = t.chosen;
  c[ImGuiCol_Header] = t.chosen;
  c[ImGuiCol_HeaderHovered] = t.hover;
  c[ImGuiCol_HeaderActive] = t.chosen;
  c[ImGuiCol_ResizeGrip] = c[ImGuiCol_ResizeGripHovered] = c[ImGuiCol_ResizeGripActive] = none;
  c[ImGuiCol_TextSelectedBg] = {t.accent.x, t.accent.y, t.accent.z, 0.4f};
  c[ImGuiCol_NavHighlight] = t.accent;
  c[ImGuiCol_ModalWindowDimBg] = t.shade;
}

}  // namespace

void use_theme(const Theme& theme, float scale) {
  current = &theme;
  current_scale = scale;
  ImGuiStyle style;
  style.WindowPadding = {px(measure::pad), px(8)};
  style.FramePadding = {px(8), px(3)};
  style.ItemSpacing = {px(8), px(measure::gap)};
  style.ItemInnerSpacing = {px(8), px(4)};
  style.IndentSpacing = px(20);
  style.ScrollbarSize = px(8);
  style.GrabMinSize = px(10);
  style.WindowRounding = 0;
  style.FrameRounding = px(3);
  style.PopupRounding = px(6);
  style.GrabRounding = px(3);
  style.ScrollbarRounding = px(4);
  style.WindowBorderSize = 0;
  style.PopupBorderSize = px(1);
  style.FrameBorderSize = px(1);
  style.WindowMinSize = {px(16), px(16)};
  style.DisabledAlpha = 0.45f;
  style.AntiAliasedLinesUseTex = true;
  set_colors(style, theme);
  ImGui::GetStyle() = style;
}

ImVec4 stiffness_tint(double factor) {
  const gpu::PointColor color = gpu::stiffness_color({205, 205, 205, 0}, factor);
  return {static_cast<float>(color.r) / 255, static_cast<float>(color.g) / 255, static_cast<float>(color.b) / 255, 1};
}

}  // namespace sinew::editor
