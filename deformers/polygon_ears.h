#pragma once
/// A polygon in space cut into triangles.

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew {

/// n - 2 triangles, wound as the polygon, with indices into it. Ears are cut off [Meisters 1975], each time the one
/// whose smallest angle is largest, in the plane across the polygon's vector area; where a bent or self-crossing
/// polygon has no ear left, the rest becomes a fan. Ears whose cut may not join its two corners are left for last.
std::vector<std::array<Index, 3>> polygon_ears(std::span<const Vec3> polygon,
                                               const std::function<bool(Index, Index)>& may_join = {});

}  // namespace sinew
