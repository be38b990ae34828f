#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/geometry/parallel.h"
#include "engine/gpu/draw_shapes.h"
#include "engine/gpu/raster.h"
#include "engine/gpu/raster_ground.h"
#include "engine/gpu/raster_splats.h"
#include "engine/gpu/raster_surface.h"

namespace sinew::gpu {
namespace {

using Eigen::Vector3f;

constexpr int pad = 8;                               ///< columns and rows around the padded depths
constexpr int most_edl_radius = pad;                 ///< so that every neighbour is there
constexpr std::size_t most_samples = 1 << 25;        ///< of a smoothed raster: above, one sample a pixel must do
constexpr std::uint32_t selected_bit = 0x80000000u;  ///< alpha's highest bit, as the shaders use alpha 1

std::uint32_t packed_color(const Vector3f& color) {
  const Vector3f scaled = (color.cwiseMax(0).cwiseMin(1) * 255.0f).array() + 0.5f;
  return static_cast<std::uint32_t>(scaled.x()) | static_cast<std::uint32_t>(scaled.y()) << 8 |
         static_cast<std::uint32_t>(scaled.z()) << 16;
}

struct Raster {
  const RasterImage& solid;
  std::span<const RasterItem> items;
  const RasterImage* ghost;
  std::span<const RasterItem> ghost_items;
  shared::ComposeConstants constants;
  int scale;
  std::vector<float>& depths;        ///< padded
  std::vector<RasterSpan>& covered;  ///< of each row: where something solid may be
  std::uint32_t* colors;             ///< of the raster's size

  std::size_t stride() const { return static_cast<std::size_t>(solid.width) + 2 * pad; }
  float* depth_row(int y) const { return depths.data() + static_cast<std::size_t>(y + pad) * stride() + pad; }
  std::uint32_t* color_row(int y) const {
    return colors + static_cast<std::size_t>(y) * static_cast<std::size_t>(solid.width);
  }
};

/// Depths of the raster with zeros around, and where in each row there are any.
void pad_depths(const Raster& raster) {
  const std::size_t stride = raster.stride(), above = pad * stride;
  raster.depths.resize(stride * static_cast<std::size_t>(raster.solid.height + 2 * pad));
  raster.covered.resize(static_cast<std::size_t>(raster.solid.height));
  std::fill_n(raster.depths.begin(), above, 0.0f);
  std::fill_n(raster.depths.rbegin(), above, 0.0f);
  parallel_for(static_cast<std::size_t>(raster.solid.height), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      float* row = raster.depth_row(static_cast<int>(y));
      std::fill_n(row - pad, pad, 0.0f);
      std::fill_n(row + raster.solid.width, pad, 0.0f);
      const std::uint64_t* keys = raster.solid.keys.data() + y * static_cast<std::size_t>(raster.solid.width);
      RasterSpan span{raster.solid.width, 0};
      for (int x = 0; x < raster.solid.width; ++x) {
        row[x] = std::bit_cast<float>(static_cast<std::uint32_t>(keys[x] >> 32));
        span.begin = keys[x] != 0 ? std::min(span.begin, x) : span.begin;
        span.end = keys[x] != 0 ? x + 1 : span.end;
      }
      raster.covered[y] = raster.ghost != nullptr ? RasterSpan{0, raster.solid.width} : span;
    }
  });
}

/// shades[x]: how much eye-dome lighting leaves of pixel x of a row, for the x of `span` (compose.frag).
void edl_row(const Raster& raster, int y, RasterSpan span, std::vector<float>& shades) {
  const shared::ComposeConstants& c = raster.constants;
  const int r = std::clamp(static_cast<int>(c.edl_radius), 1, most_edl_radius);
  const int d = std::clamp(static_cast<int>(std::lround(0.7f * c.edl_radius)), 1, most_edl_radius);
  const float *here = raster.depth_row(y), *up = raster.depth_row(y - r), *down = raster.depth_row(y + r);
  const float *high = raster.depth_row(y - d), *low = raster.depth_row(y + d);
  const float linear = c.linear_depth, strength = c.edl_strength;
  float* out = shades.data();
  for (int x = span.begin; x < span.end; ++x) {
    const float z = here[x];
    const float scale = linear > 0 ? linear : shared::inverse_ln2 / std::max(z, 1e-30f);
    const auto tap = [&](float there) { return std::clamp((there - z) * scale, 0.0f, shared::edl_limit); };
    const float sum = tap(here[x + r]) + tap(here[x - r]) + tap(up[x]) + tap(down[x]) + tap(low[x + d]) +
                      tap(low[x - d]) + tap(high[x + d]) + tap(high[x - d]);
    out[x] = shared::edl_shade(strength * sum);
  }
}

/// A row of the gradient with its dither (backdrop.frag), `out` in raster pixels.
void backdrop_row(const Raster& raster, int y, std::uint32_t* out) {
  const shared::ComposeConstants& c = raster.constants;
  const float t = (static_cast<float>(y) + 0.5f) / (c.size.y() * static_cast<float>(raster.scale));
  const Vector3f color =
      (255.0f * (color_of(c.top) * (1 - t) + color_of(c.bottom) * t)).cwiseMax(0.5f).cwiseMin(254.5f);
  const float red = color.x(), green = color.y(), blue = color.z();
  const float down = (static_cast<float>(y) + 0.5f) * 0.00583715f;
  const int width = raster.solid.width;
  for (int x = 0; x < width; ++x) {
    const float inner = (static_cast<float>(x) + 0.5f) * 0.06711056f + down;
    const float outer = 52.9829189f * (inner - std::floor(inner));
    const float dither = outer - std::floor(outer);  // with the half that rounds
    out[x] = static_cast<std::uint32_t>(static_cast<std::int32_t>(red + dither) |
                                        static_cast<std::int32_t>(green + dither) << 8 |
                                        static_cast<std::int32_t>(blue + dither) << 16);
  }
}

/// The grid over what lies below it (ground.frag).
void blend_ground(const Raster& raster, int y, const GroundRow& ground, const Vector3f& color) {
  std::uint32_t* out = raster.color_row(y);
  const float* depths = raster.depth_row(y);
  for (int x = 0; x < raster.solid.width; ++x) {
    const auto i = static_cast<std::size_t>(x);
    if (ground.opacity[i] <= 0 || depths[x] > ground.depth[i]) continue;
    const Vector3f below = color_of(out[x]);
    out[x] = packed_color(below + ground.opacity[i] * (color - below)) | (out[x] & selected_bit);
  }
}

void shade_row(const Raster& raster, int y, std::vector<float>& shades) {
  const RasterImage& solid = raster.solid;
  const RasterSpan span = raster.covered[static_cast<std::size_t>(y)];
  shades.assign(static_cast<std::size_t>(solid.width), 1.0f);
  if (raster.constants.edl_strength > 0) edl_row(raster, y, span, shades);
  std::uint32_t* out = raster.color_row(y);
  backdrop_row(raster, y, out);
  const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(solid.width);
  for (int x = span.begin; x < span.end; ++x) {
    const std::size_t pixel = first + static_cast<std::size_t>(x);
    const bool ghost = raster.ghost != nullptr && raster.ghost->keys[pixel] >> 32 > solid.keys[pixel] >> 32;
    if (solid.empty(pixel) && !ghost) continue;
    Shaded shaded{color_of(out[x])};
    if (!solid.empty(pixel)) {
      shaded = shade(raster.items, solid, pixel);
      shaded.color *= shades[static_cast<std::size_t>(x)];
    }
    if (ghost) {
      const Shaded over = shade(raster.ghost_items, *raster.ghost, pixel);
      shaded.color += over.alpha * (over.color - shaded.color);
    }
    out[x] = packed_color(shaded.color) | (shaded.selected ? selected_bit : 0);
  }
}

/// Pixels beside selected ones take the outline's colour (compose.frag). Found first and coloured afterwards, because
/// rows read the rows around them.
void draw_outline(const Raster& raster, std::vector<std::uint8_t>& selected) {
  const auto width = static_cast<std::size_t>(raster.solid.width),
             height = static_cast<std::size_t>(raster.solid.height), reach = static_cast<std::size_t>(raster.scale);
  selected.resize(width * height);
  std::vector<std::uint8_t> any(height);  // of a row's pixels is selected
  parallel_for(height, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      const std::uint32_t* colors = raster.color_row(static_cast<int>(y));
      std::uint8_t* row = selected.data() + y * width;
      std::uint32_t all = 0;
      for (std::size_t x = 0; x < width; ++x) {
        row[x] = (colors[x] & selected_bit) != 0;
        all |= colors[x];
      }
      any[y] = (all & selected_bit) != 0;
    }
  });
  const std::uint32_t outline = raster.constants.outline & 0xffffffu;
  parallel_for(height, 16, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint8_t> near(width + 2 * reach);  // of the rows above and below, `reach` columns to the right
    for (std::size_t y = begin; y < end; ++y) {
      const std::size_t top = y - std::min(y, reach), bottom = std::min(height - 1, y + reach);
      std::fill(near.begin(), near.end(), std::uint8_t{0});
      bool found = false;
      for (std::size_t v = top; v <= bottom; ++v) {
        if (any[v] == 0) continue;
        found = true;
        for (std::size_t x = 0; x < width; ++x) near[x + reach] |= selected[v * width + x];
      }
      if (!found) continue;
      std::uint32_t* colors = raster.color_row(static_cast<int>(y));
      for (std::size_t x = 0; x < width; ++x) {
        std::uint8_t hit = 0;
        for (std::size_t k = 0; k <= 2 * reach; ++k) hit |= near[x + k];
        if (hit > selected[y * width + x]) colors[x] = outline;
      }
    }
  });
}

std::uint32_t ordered(std::uint32_t rgba, bool blue_first) {
  const std::uint32_t color =
      blue_first ? (rgba & 0xff00u) | (rgba & 0xffu) << 16 | (rgba >> 16 & 0xffu) : rgba & 0xffffffu;
  return color | 0xff000000u;
}

/// Averages scale x scale colours, and takes one of their depths, as a resolved depth is one sample's.
void write_output(const Raster& raster, VkExtent2D extent, const RasterOutput& out) {
  const int scale = raster.scale;
  const auto width = static_cast<int>(extent.width);
  parallel_for(extent.height, 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t y = begin; y < end; ++y) {
      std::uint32_t* colors = out.colors + y * extent.width;
      float* depths = out.depths + y * extent.width;
      const int row = static_cast<int>(y) * scale;
      const float* depth = raster.depth_row(row);
      if (scale == 1) {
        for (int x = 0; x < width; ++x) colors[x] = ordered(raster.color_row(row)[x], out.blue_first);
        std::copy(depth, depth + width, depths);
        continue;
      }
      const std::uint32_t *a = raster.color_row(row), *b = raster.color_row(row + 1);
      for (int x = 0; x < width; ++x) {
        // Two channels at a time: sums of four bytes fit into 16 bits.
        const std::uint32_t p = a[2 * x], q = a[2 * x + 1], r = b[2 * x], s = b[2 * x + 1];
        const std::uint32_t red_blue = (p & 0xff00ffu) + (q & 0xff00ffu) + (r & 0xff00ffu) + (s & 0xff00ffu) + 0x20002u;
        const std::uint32_t green = (p >> 8 & 0xffu) + (q >> 8 & 0xffu) + (r >> 8 & 0xffu) + (s >> 8 & 0xffu) + 2u;
        colors[x] = ordered((red_blue >> 2 & 0xff00ffu) | (green >> 2 & 0xffu) << 8, out.blue_first);
        depths[x] = depth[2 * x];
      }
    }
  });
}

}  // namespace

void raster_scene(RasterScratch& scratch, const Scene& scene, VkExtent2D extent, const RasterOutput& out) {
  const bool fits = std::size_t{4} * extent.width * extent.height <= most_samples;
  const int scale = scene.smooth_edges && fits ? 2 : 1;
  const int width = static_cast<int>(extent.width) * scale, height = static_cast<int>(extent.height) * scale;
  std::vector<RasterItem> items = raster_items(scene, extent, false, scale);
  std::vector<RasterItem> ghosts = raster_items(scene, extent, true, scale);
  raster(scratch.solid, width, height, items);
  if (!ghosts.empty()) raster(scratch.ghost, width, height, ghosts);

  Raster state{scratch.solid,
               items,
               ghosts.empty() ? nullptr : &scratch.ghost,
               ghosts,
               compose_constants(scene, extent),
               scale,
               scratch.depths,
               scratch.covered,
               out.colors};
  state.constants.edl_radius *= static_cast<float>(scale);
  if (scale > 1) {
    scratch.colors.resize(scratch.solid.keys.size());
    state.colors = scratch.colors.data();
  }
  pad_depths(state);
  const RasterGround ground(scene, extent, scale);
  const Vector3f grid = color_of(packed(scene.look.grid));
  parallel_for(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
    std::vector<float> shades;
    GroundRow ground_row;
    for (std::size_t y = begin; y < end; ++y) {
      shade_row(state, static_cast<int>(y), shades);
      if (!scene.ground.show) continue;
      ground.row(static_cast<int>(y), ground_row);
      blend_ground(state, static_cast<int>(y), ground_row, grid);
    }
  });
  if (state.constants.outline != 0) draw_outline(state, scratch.selected);
  write_output(state, extent, out);
  raster_splats(scene, extent, out);
}

}  // namespace sinew::gpu
