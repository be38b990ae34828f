#include "engine/gpu/raster_splats.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/parallel.h"
#include "engine/gpu/splats.h"

namespace sinew::gpu {
namespace {

using shared::SplatInstance;

/// Pixels that are blended at once: whole vectors of any processor.
constexpr int lanes = 8;
using Lanes = Eigen::Array<float, lanes, 1>;

/// Rows [first, end) of a picture as floats 0..1, each channel apart, so that hundreds of faint splats add up before
/// they are rounded. Rows are padded to whole Lanes.
struct Band {
  int width, first, end;
  std::size_t stride;
  std::vector<float> channels[3], depths;

  Band(const RasterOutput& out, int picture_width, int first_row, int end_row)
      : width(picture_width),
        first(first_row),
        end(end_row),
        stride(static_cast<std::size_t>((picture_width + lanes - 1) / lanes * lanes)) {
    for (std::vector<float>& channel : channels) channel.resize(stride * static_cast<std::size_t>(end - first));
    depths.resize(channels[0].size());
    each_pixel([&](std::size_t i, std::size_t pixel) {
      for (std::size_t c = 0; c < 3; ++c)
        channels[c][i] = static_cast<float>(out.colors[pixel] >> shift(out, c) & 255) / 255.0f;
      depths[i] = out.depths[pixel];
    });
  }

  void write(const RasterOutput& out) const {
    each_pixel([&](std::size_t i, std::size_t pixel) {
      std::uint32_t color = 0xff000000u;
      for (std::size_t c = 0; c < 3; ++c)
        color |= static_cast<std::uint32_t>(std::lround(channels[c][i] * 255.0f)) << shift(out, c);
      out.colors[pixel] = color;
    });
  }

  void blend(const SplatInstance& splat);

 private:
  static std::size_t shift(const RasterOutput& out, std::size_t channel) {
    return 8 * (out.blue_first ? 2 - channel : channel);
  }

  template <class Body>
  void each_pixel(const Body& body) const {
    for (int y = first; y < end; ++y)
      for (int x = 0; x < width; ++x)
        body(static_cast<std::size_t>(y - first) * stride + static_cast<std::size_t>(x),
             static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

void Band::blend(const SplatInstance& splat) {
  const float x = splat.at.x(), y = splat.at.y(), depth = splat.at.z();
  // As floats first: a splat that is close to the eye reaches beyond any int.
  const auto pixel = [](float at, int least, int most) {
    return static_cast<int>(std::clamp(at, static_cast<float>(least), static_cast<float>(most)));
  };
  const int top = pixel(std::floor(y - splat.reach.y()), first, end);
  const int bottom = pixel(std::ceil(y + splat.reach.y()), first, end);
  const int left = pixel(std::floor(x - splat.reach.x()), 0, width) / lanes * lanes;
  const int right = pixel(std::ceil(x + splat.reach.x()), 0, width);
  const float a = splat.conic.x(), b = splat.conic.y(), c = splat.conic.z();
  const Lanes steps = Lanes::LinSpaced(0.5f, lanes - 0.5f);
  for (int row = top; row < bottom; ++row) {
    const float dy = static_cast<float>(row) + 0.5f - y;
    const std::size_t begin = static_cast<std::size_t>(row - first) * stride;
    for (int column = left; column < right; column += lanes) {
      const Lanes dx = steps + (static_cast<float>(column) - x);
      const Lanes squared = a * dx.square() + (2 * b * dy) * dx + c * dy * dy;
      const std::size_t i = begin + static_cast<std::size_t>(column);
      const Lanes density = splat.color.w() * (-0.5f * squared).exp();
      const Eigen::Map<const Lanes> before(depths.data() + i);
      const Lanes alpha =
          (squared <= shared::splat_cut && density >= shared::splat_least && before <= depth).select(density, 0.0f);
      for (int k = 0; k < 3; ++k) {
        Eigen::Map<Lanes> channel(channels[k].data() + i);
        channel = (channel + alpha * (splat.color[k] - channel)).min(1.0f);
      }
    }
  }
}

}  // namespace

void raster_splats(const Scene& scene, VkExtent2D extent, const RasterOutput& out) {
  if (scene.splats.empty()) return;
  const std::vector<SplatInstance> splats = splat_instances(scene, extent);
  const auto width = static_cast<int>(extent.width), height = static_cast<int>(extent.height);
  const int rows = std::max(16, height / (thread_count() > 1 ? 2 * thread_count() : 1) + 1);
  const auto bands = static_cast<std::size_t>((height + rows - 1) / rows);
  parallel_for(bands, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t k = begin; k < end; ++k) {
      const int first = static_cast<int>(k) * rows;
      Band band(out, width, first, std::min(height, first + rows));
      for (const SplatInstance& splat : splats) band.blend(splat);
      band.write(out);
    }
  });
}

}  // namespace sinew::gpu
