#pragma once
/// Coordinates of points beside a triangle a, b, c.

#include "engine/geometry/shape.h"

namespace sinew {

/// p = weights a, b, c + height n, n the unit normal: the coordinates of any p, which may lie beside the triangle. Of a
/// triangle without area, the nearest corner's, and no height.
struct TriangleCoordinates {
  Vec3 weights = Vec3::Zero();
  double height = 0;
};
TriangleCoordinates coordinates_in(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

/// Barycentric coordinates, each 0..1, of the point of a triangle that is nearest to p; of any triangle, also of one
/// without area.
Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c);

}  // namespace sinew
