#include "engine/gpu/level_of_detail.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/geometry/bounds.h"
#include "engine/geometry/random.h"

namespace sinew::gpu {
namespace {

constexpr int levels = 10;  ///< the finest grid has 2^levels cells along the longest side

/// Bits of x, y, z in turn, the highest first: a prefix of the code is a cell of a coarser grid.
std::uint64_t morton(const Eigen::Vector3d& unit) {
  std::uint64_t code = 0;
  std::uint32_t cell[3];
  for (int c = 0; c < 3; ++c) cell[c] = static_cast<std::uint32_t>(unit[c] * ((1 << levels) - 1));
  for (int bit = levels - 1; bit >= 0; --bit)
    for (const std::uint32_t x : cell) code = code << 1 | (x >> bit & 1);
  return code;
}

struct Key {
  std::uint64_t code;  ///< Morton; ~0 where not finite
  std::uint64_t hash;
  std::uint32_t index;
};

}  // namespace

std::vector<std::uint32_t> progressive_order(std::span<const Eigen::Vector3d> points) {
  const Bounds bounds = bounds_of(points);
  const double side = bounds.empty() ? 1 : (bounds.max - bounds.min).maxCoeff();
  const double scale = side > 0 ? 1 / side : 0;
  std::vector<Key> keys(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const bool finite = points[i].allFinite();
    keys[i] = {finite ? morton((points[i] - bounds.min) * scale) : ~std::uint64_t{0}, mixed(i),
               static_cast<std::uint32_t>(i)};
  }
  std::sort(keys.begin(), keys.end(),
            [](const Key& a, const Key& b) { return a.code != b.code ? a.code < b.code : a.hash < b.hash; });
  // A point's level is that of the coarsest grid where it is the first of its cell along the curve.
  std::vector<int> level(points.size(), levels + 2);
  for (std::size_t k = 0; k < keys.size(); ++k) {
    if (keys[k].code == ~std::uint64_t{0}) break;
    if (k == 0) {
      level[k] = 0;
      continue;
    }
    const std::uint64_t differs = keys[k].code ^ keys[k - 1].code;
    level[k] = differs == 0 ? levels + 1 : levels - (static_cast<int>(std::bit_width(differs)) - 1) / 3;
  }
  std::vector<std::uint32_t> place(points.size());
  for (std::size_t k = 0; k < place.size(); ++k) place[k] = static_cast<std::uint32_t>(k);
  std::sort(place.begin(), place.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (level[a] != level[b]) return level[a] < level[b];
    return keys[a].hash != keys[b].hash ? keys[a].hash < keys[b].hash : keys[a].index < keys[b].index;
  });
  std::vector<std::uint32_t> order(points.size());
  for (std::size_t k = 0; k < order.size(); ++k) order[k] = keys[place[k]].index;
  return order;
}

std::size_t next_count(std::size_t drawn, double taken_ms, double wanted_ms, std::size_t least, std::size_t most) {
  const double factor = std::clamp(wanted_ms / std::max(taken_ms, 1e-3), 0.5, 2.0);
  const auto count = static_cast<std::size_t>(factor * static_cast<double>(drawn));
  return std::clamp(count, std::min(least, most), most);
}

}  // namespace sinew::gpu
