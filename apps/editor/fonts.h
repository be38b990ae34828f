#pragma once
/// Fonts of the window: Inter and Fork Awesome, found where the system keeps its fonts.

#include <imgui.h>

#include <span>
#include <vector>

#include "engine/gpu/offscreen.h"

namespace sinew::editor {

/// Text 13, bold 13, small bold 11 (headings in capitals), big 20, icons 16, in pixels of the em at scale 1. The four
/// text fonts hold the icons too. Figures are as wide as each other.
struct Fonts {
  /// Where a picture is in the texture of the fonts, the only one that Dear ImGui's backend of 1.86 can show.
  struct Place {
    ImVec2 from{0, 0}, to{0, 0};
  };

  ImFont *text = nullptr, *bold = nullptr, *small = nullptr, *big = nullptr, *icons = nullptr;
  std::vector<Place> pictures;  ///< of those that load_fonts was given
};

/// Fills Dear ImGui's font atlas anew, small pictures beside the glyphs. Throws InputError that names the package of a
/// missing font.
Fonts load_fonts(float scale, std::span<const gpu::Picture> pictures);

}  // namespace sinew::editor
