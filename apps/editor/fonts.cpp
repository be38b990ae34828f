#include "apps/editor/fonts.h"

#include <imgui_internal.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "apps/editor/icons.h"
#include "engine/geometry/error.h"

namespace sinew::editor {

namespace {

namespace fs = std::filesystem;

/// Folders that hold fonts on this system, the user's own first.
std::vector<fs::path> font_folders() {
  std::vector<fs::path> folders;
  if (const char* home = std::getenv("XDG_DATA_HOME")) folders.push_back(fs::path(home) / "fonts");
  if (const char* home = std::getenv("HOME")) folders.push_back(fs::path(home) / ".local/share/fonts");
  const char* set = std::getenv("XDG_DATA_DIRS");
  std::istringstream list(set != nullptr && *set != 0 ? set : "/usr/local/share:/usr/share");
  for (std::string folder; std::getline(list, folder, ':');) folders.push_back(fs::path(folder) / "fonts");
  folders.emplace_back("/usr/share/fonts");
  return folders;
}

/// The first file of one of these names in the folders or below them; empty where there is none.
std::string find_below(const std::vector<std::string>& names) {
  const auto options = fs::directory_options::skip_permission_denied;
  for (const fs::path& folder : font_folders()) {
    std::error_code error;
    for (fs::recursive_directory_iterator it(folder, options, error), end; !error && it != end; it.increment(error))
      if (std::find(names.begin(), names.end(), it->path().filename().string()) != names.end())
        return it->path().string();
  }
  return {};
}

std::string font_file(const std::string& usual, const std::vector<std::string>& names, const char* package) {
  std::error_code error;
  if (fs::is_regular_file(usual, error)) return usual;
  const std::string found = find_below(names);
  if (found.empty())
    throw InputError("fonts: expected " + names.front() + " (Debian package " + package +
                     "), found none in the system's font folders");
  return found;
}

std::string inter(const std::string& weight) {
  const std::string name = "Inter-" + weight;
  return font_file("/usr/share/fonts/opentype/inter/" + name + ".otf", {name + ".otf", name + ".ttf"}, "fonts-inter");
}

/// Figures of one width, so that numbers that change do not make their line tremble: each is centred in the widest.
void make_figures_tabular(ImFont* font) {
  float widest = 0;
  for (ImWchar c = '0'; c <= '9'; ++c) widest = std::max(widest, font->GetCharAdvance(c));
  for (ImWchar c = '0'; c <= '9'; ++c) {
    auto* glyph = const_cast<ImFontGlyph*>(font->FindGlyphNoFallback(c));
    if (glyph == nullptr) continue;
    const float shift = 0.5f * (widest - glyph->AdvanceX);
    glyph->X0 += shift;
    glyph->X1 += shift;
    glyph->AdvanceX = widest;
    font->IndexAdvanceX[c] = widest;
  }
}

// Latin, Greek, Cyrillic, punctuation, arrows and signs that file names and messages may hold.
constexpr ImWchar text_ranges[] = {0x20,   0x24f,  0x370,  0x3ff,  0x400,  0x52f,  0x1e00, 0x1eff, 0x2000,
                                   0x206f, 0x2070, 0x209f, 0x2190, 0x21ff, 0x2200, 0x22ff, 0};
constexpr ImWchar icon_ranges[] = {static_cast<ImWchar>(icon::first), static_cast<ImWchar>(icon::last), 0};

/// Room for the pictures in the atlas; the numbers of their places.
std::vector<int> reserve(std::span<const gpu::Picture> pictures) {
  std::vector<int> out;
  for (const gpu::Picture& picture : pictures)
    out.push_back(ImGui::GetIO().Fonts->AddCustomRectRegular(picture.width, picture.height));
  return out;
}

/// Copies them into the built atlas.
std::vector<Fonts::Place> place(std::span<const gpu::Picture> pictures, std::span<const int> rects) {
  ImFontAtlas& atlas = *ImGui::GetIO().Fonts;
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  atlas.GetTexDataAsRGBA32(&pixels, &width, &height);
  std::vector<Fonts::Place> out;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const ImFontAtlasCustomRect& rect = *atlas.GetCustomRectByIndex(rects[i]);
    for (int y = 0; y < pictures[i].height; ++y)
      std::copy_n(pictures[i].at(0, y), 4 * pictures[i].width, pixels + 4 * ((rect.Y + y) * width + rect.X));
    Fonts::Place place;
    atlas.CalcCustomRectUV(&rect, &place.from, &place.to);
    out.push_back(place);
  }
  return out;
}

class Loader {
 public:
  explicit Loader(float scale)
      : scale_(scale),
        icons_(font_file("/usr/share/fonts/truetype/fork-awesome/forkawesome-webfont.ttf", {"forkawesome-webfont.ttf"},
                         "fonts-fork-awesome")) {}

  /// Dear ImGui counts a font's height from ascender to descender: 1.21 em for Inter, 1 em for Fork Awesome (roughly).
  ImFont* text(const std::string& weight, float em, float icon_em) {
    ImFontConfig config;
    config.OversampleH = 3;
    config.OversampleV = 1;
    ImFont* font = add(inter(weight), std::round(em * 1.21f * scale_), config, text_ranges);
    ImFontConfig merged;
    merged.MergeMode = true;
    merged.GlyphOffset.y = std::round(0.1f * em * scale_);
    add(icons_, std::round(icon_em * scale_), merged, icon_ranges);
    return font;
  }

  ImFont* icons(float em) {
    ImFontConfig config;
    config.OversampleH = 2;
    return add(icons_, std::round(em * scale_), config, icon_ranges);
  }

 private:
  static ImFont* add(const std::string& path, float size, const ImFontConfig& config, const ImWchar* ranges) {
    ImFont* font = ImGui::GetIO().Fonts->AddFontFromFileTTF(path.c_str(), size, &config, ranges);
    if (font == nullptr) throw file_error(path, "a readable TrueType or OpenType font", "none");
    return font;
  }

  float scale_;
  std::string icons_;
};

}  // namespace

Fonts load_fonts(float scale, std::span<const gpu::Picture> pictures) {
  ImGui::GetIO().Fonts->Clear();
  ImGui::GetIO().Fonts->TexDesiredWidth = scale > 1.6f ? 2048 : 1024;
  Loader loader(scale);
  Fonts fonts;
  fonts.text = loader.text("Regular", 13, 14);
  fonts.bold = loader.text("SemiBold", 13, 14);
  fonts.small = loader.text("SemiBold", 11, 11);
  fonts.big = loader.text("Medium", 20, 20);
  fonts.icons = loader.icons(16);
  ImGui::GetIO().FontDefault = fonts.text;
  const std::vector<int> rects = reserve(pictures);
  ImGui::GetIO().Fonts->Build();
  fonts.pictures = place(pictures, rects);
  for (ImFont* font : {fonts.text, fonts.bold, fonts.small, fonts.big}) make_figures_tabular(font);
  return fonts;
}

}  // namespace sinew::editor
