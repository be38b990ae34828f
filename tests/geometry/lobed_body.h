#pragma once
/// A closed body without any symmetry, about 3 long, and places on it, for tests that find out how points lie on it.

#include <array>
#include <cmath>
#include <numbers>

#include "engine/geometry/random.h"
#include "engine/geometry/shape.h"
#include "engine/geometry/topology.h"

namespace sinew::test {

/// A ball with five limbs of different lengths and widths: rings of vertices from pole to pole.
inline Shape lobed_body() {
  struct Limb {
    Vec3 direction;
    double length, sharpness;
  };
  const Limb limbs[] = {{{0.5, -1, 0.1}, 1.4, 30},
                        {{-0.4, -1, 0}, 1.2, 25},
                        {{1, 0.5, 0.3}, 1.0, 40},
                        {{-1, 0.3, -0.2}, 0.9, 35},
                        {{0.1, 1, 0.4}, 0.5, 12}};
  constexpr Index rings = 48, around = 80;
  Shape out;
  const auto add = [&](double polar, double azimuth) {
    const Vec3 n(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth));
    double radius = 0.5;
    for (const Limb& limb : limbs)
      radius += limb.length * std::exp(limb.sharpness * (n.dot(limb.direction.normalized()) - 1));
    out.positions.push_back(radius * n);
  };
  add(0, 0);
  for (Index i = 1; i < rings; ++i)
    for (Index k = 0; k < around; ++k) add(std::numbers::pi * i / rings, 2 * std::numbers::pi * k / around);
  add(std::numbers::pi, 0);
  const Index last = static_cast<Index>(out.size()) - 1;
  const auto at = [&](Index ring, Index k) { return 1 + (ring - 1) * around + k % around; };
  for (Index k = 0; k < around; ++k) {
    out.faces.add(std::array{Index{0}, at(1, k + 1), at(1, k)});
    for (Index i = 1; i + 1 < rings; ++i)
      out.faces.add(std::array{at(i, k), at(i, k + 1), at(i + 1, k + 1), at(i + 1, k)});
    out.faces.add(std::array{last, at(rings - 1, k), at(rings - 1, k + 1)});
  }
  return out;
}

/// `count` places on faces of the shape, other ones for another seed.
inline std::vector<Vec3> places_on(const Shape& shape, std::size_t count, std::uint64_t seed) {
  const std::vector<Index> corners = triangles_of(shape.faces);
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t face = random_bits(seed, 3 * i) % (corners.size() / 3);
    double u = random_unit(seed, 3 * i + 1), v = random_unit(seed, 3 * i + 2);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const auto corner = [&](std::size_t k) { return shape.positions[corners[3 * face + k]]; };
    out.push_back((1 - u - v) * corner(0) + u * corner(1) + v * corner(2));
  }
  return out;
}

}  // namespace sinew::test
