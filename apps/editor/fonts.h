#pragma once
/// Fonts of the window: Inter and Fork Awesome, found where the system keeps its fonts.

#include <imgui.h>

namespace sinew::editor {

/// Text 13, bold 13, small bold 11 (headings in capitals), big 20, icons 16, in pixels of the em at scale 1. The four
/// text fonts hold the icons too. Figures are as wide as each other.
struct Fonts {
  ImFont *text = nullptr, *bold = nullptr, *small = nullptr, *big = nullptr, *icons = nullptr;
};

/// Fills Dear ImGui's font atlas anew. Throws InputError that names the package of a missing font.
Fonts load_fonts(float scale);

}  // namespace sinew::editor
