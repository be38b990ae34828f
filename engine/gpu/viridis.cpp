#include "engine/gpu/viridis.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace sinew::gpu {

PointColor viridis(double x) {
  constexpr std::array<std::array<double, 3>, 9> table{{{68, 1, 84},
                                                        {71, 44, 122},
                                                        {59, 81, 139},
                                                        {44, 113, 142},
                                                        {33, 144, 141},
                                                        {39, 173, 129},
                                                        {92, 200, 99},
                                                        {170, 220, 50},
                                                        {253, 231, 37}}};
  const double at = std::clamp(x, 0.0, 1.0) * 8;
  const std::size_t low = std::min<std::size_t>(7, static_cast<std::size_t>(at));
  const double part = at - static_cast<double>(low);
  const auto channel = [&](std::size_t c) {
    return static_cast<std::uint8_t>(std::lround(table[low][c] + part * (table[low + 1][c] - table[low][c])));
  };
  return {channel(0), channel(1), channel(2), 0};
}

}  // namespace sinew::gpu
