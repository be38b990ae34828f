#include "apps/sinew/legend.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace sinew::app {

namespace {

/// The letters that legends need, 5 x 7: a row a byte from the top, the leftmost pixel the highest of five bits.
struct Glyph {
  char letter;
  std::array<std::uint8_t, 7> rows;
};
constexpr Glyph glyphs[] = {
    // clang-format off
    {'0', {0x0e, 0x11, 0x13, 0x15, 0x19, 0x11, 0x0e}},
    {'1', {0x04, 0x0c, 0x04, 0x04, 0x04, 0x04, 0x0e}},
    {'2', {0x0e, 0x11, 0x01, 0x06, 0x08, 0x10, 0x1f}},
    {'3', {0x1f, 0x02, 0x04, 0x02, 0x01, 0x11, 0x0e}},
    {'4', {0x02, 0x06, 0x0a, 0x12, 0x1f, 0x02, 0x02}},
    {'5', {0x1f, 0x10, 0x1e, 0x01, 0x01, 0x11, 0x0e}},
    {'6', {0x06, 0x08, 0x10, 0x1e, 0x11, 0x11, 0x0e}},
    {'7', {0x1f, 0x01, 0x02, 0x04, 0x08, 0x08, 0x08}},
    {'8', {0x0e, 0x11, 0x11, 0x0e, 0x11, 0x11, 0x0e}},
    {'9', {0x0e, 0x11, 0x11, 0x0f, 0x01, 0x02, 0x0c}},
    {'.', {0x00, 0x00, 0x00, 0x00, 0x00, 0x0c, 0x0c}},
    {'-', {0x00, 0x00, 0x00, 0x0e, 0x00, 0x00, 0x00}},
    {'+', {0x00, 0x04, 0x04, 0x1f, 0x04, 0x04, 0x00}},
    {'a', {0x00, 0x00, 0x0e, 0x01, 0x0f, 0x11, 0x0f}},
    {'c', {0x00, 0x00, 0x0e, 0x10, 0x10, 0x11, 0x0e}},
    {'d', {0x01, 0x01, 0x0d, 0x13, 0x11, 0x11, 0x0f}},
    {'e', {0x00, 0x00, 0x0e, 0x11, 0x1f, 0x10, 0x0e}},
    {'g', {0x00, 0x00, 0x0f, 0x11, 0x0f, 0x01, 0x0e}},
    {'i', {0x04, 0x00, 0x0c, 0x04, 0x04, 0x04, 0x0e}},
    {'l', {0x0c, 0x04, 0x04, 0x04, 0x04, 0x04, 0x0e}},
    {'m', {0x00, 0x00, 0x1a, 0x15, 0x15, 0x15, 0x15}},
    {'n', {0x00, 0x00, 0x16, 0x19, 0x11, 0x11, 0x11}},
    {'p', {0x00, 0x00, 0x1e, 0x11, 0x1e, 0x10, 0x10}},
    {'r', {0x00, 0x00, 0x16, 0x19, 0x10, 0x10, 0x10}},
    {'s', {0x00, 0x00, 0x0f, 0x10, 0x0e, 0x01, 0x1e}},
    {'t', {0x08, 0x08, 0x1c, 0x08, 0x08, 0x09, 0x06}},
    {'y', {0x00, 0x00, 0x11, 0x11, 0x0f, 0x01, 0x0e}},
    // clang-format on
};
constexpr int advance = 6, line_height = 7;

/// A picture that is drawn into, in squares of `scale` pixels.
struct Canvas {
  gpu::Picture& picture;
  int scale;

  void square(int x, int y, gpu::PointColor color) const {
    for (int v = y * scale; v < (y + 1) * scale; ++v)
      for (int u = x * scale; u < (x + 1) * scale; ++u) {
        const std::size_t pixel =
            static_cast<std::size_t>(v) * static_cast<std::size_t>(picture.width) + static_cast<std::size_t>(u);
        std::uint8_t* rgba = picture.rgba.data() + 4 * pixel;
        rgba[0] = color.r;
        rgba[1] = color.g;
        rgba[2] = color.b;
      }
  }

  void text(int x, int y, const std::string& letters) const {
    for (const char letter : letters) {
      for (const Glyph& glyph : glyphs) {
        if (glyph.letter != letter) continue;
        for (int row = 0; row < line_height; ++row)
          for (int column = 0; column < 5; ++column)
            if ((glyph.rows[static_cast<std::size_t>(row)] >> (4 - column) & 1) != 0)
              square(x + column, y + row, {225, 225, 225, 0});
      }
      x += advance;
    }
  }
};

}  // namespace

void draw_legend(gpu::Picture& picture, const Field& field) {
  constexpr int margin = 6, width = 100, height = 5;
  const Canvas canvas{picture, std::max(1, picture.height / 400)};
  const int bottom = picture.height / canvas.scale - margin;
  if (picture.width / canvas.scale < width + 2 * margin || bottom < 3 * line_height + height) return;
  const std::string high = fmt::format("{:.2g}", field.high);
  const int numbers = bottom - line_height, bar = numbers - 2 - height, name = bar - 3 - line_height;
  canvas.text(margin, name, field.name);
  for (int x = 0; x < width; ++x)
    for (int y = 0; y < height; ++y) canvas.square(margin + x, bar + y, color_of(field, field.high * x / (width - 1)));
  canvas.text(margin, numbers, "0");
  canvas.text(margin + width + 1 - advance * static_cast<int>(high.size()), numbers, high);
}

}  // namespace sinew::app
