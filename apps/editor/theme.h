#pragma once
/// Theme: the colours and measures of the window. Measures are pixels at scale 1 and multiples of 4 where they place
/// things; px() makes them pixels of the screen, whole ones.

#include <imgui.h>

#include "engine/gpu/scene.h"

namespace sinew::editor {

/// Colours of one theme, opaque unless said otherwise.
struct Theme {
  const char* name = "Dark";
  ImVec4 panel;   ///< behind columns and bars, slightly see-through
  ImVec4 popup;   ///< behind menus, dialogs, tooltips
  ImVec4 field;   ///< inside what can be typed into
  ImVec4 line;    ///< between things
  ImVec4 hover;   ///< under the mouse
  ImVec4 chosen;  ///< the chosen one of several
  ImVec4 text, quiet, faint;
  ImVec4 accent;     ///< what is on, sliders, the focused field's edge
  ImVec4 on_accent;  ///< text on it
  ImVec4 handle, fixed, rigid;
  ImVec4 axes[3];
  ImVec4 shade;  ///< over the scene while a dialog is open, see-through
  ImVec4 warning;
  gpu::Look look;
};
const Theme& dark_theme();
const Theme& light_theme();

namespace measure {
inline constexpr float row = 24, gap = 4, pad = 12, menu_bar = 28, status_line = 24, tool_button = 30;
inline constexpr float timeline = 60, tool_column = 40, right_column = 272, edge = 12, label_column = 104;
}  // namespace measure

/// The theme and scale that are used now. Set between frames.
void use_theme(const Theme& theme, float scale);
const Theme& theme();
float scale();
float px(float at_scale_1);  ///< rounded to whole pixels, never below 1 where `at_scale_1` is above 0
ImU32 packed(const ImVec4& color, float opacity = 1);
/// What stands for a stiffness in the interface.
ImVec4 stiffness_tint(double factor);

}  // namespace sinew::editor
