#pragma once
/// What the tests of samples ask of a shape.

#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <span>

#include "engine/geometry/shape.h"

namespace sinew::samples {

/// FNV-1a.
inline std::uint64_t hash_of(std::span<const std::byte> bytes, std::uint64_t hash = 0xcbf29ce484222325u) {
  for (const std::byte byte : bytes) hash = (hash ^ static_cast<std::uint64_t>(byte)) * 0x100000001b3u;
  return hash;
}

inline std::uint64_t hash_of(const Shape& shape) {
  std::uint64_t hash = hash_of(std::as_bytes(std::span(shape.positions)));
  for (const Attribute& attribute : shape.attributes) hash = hash_of(attribute.values, hash);
  return hash_of(std::as_bytes(std::span(shape.faces.points)), hash);
}

inline bool all_finite(const Shape& shape) {
  for (const Vec3& p : shape.positions)
    if (!p.allFinite()) return false;
  for (const Attribute& attribute : shape.attributes)
    for (std::size_t i = 0; i < attribute.count(); ++i)
      for (int c = 0; c < attribute.components; ++c)
        if (!std::isfinite(attribute.number(i, c))) return false;
  return true;
}

/// Six times the volume that closed triangles enclose.
inline double volume6(const Shape& shape) {
  double sum = 0;
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    const auto c = shape.faces[f];
    sum += shape.positions[c[0]].cross(shape.positions[c[1]]).dot(shape.positions[c[2]]);
  }
  return sum;
}

}  // namespace sinew::samples
