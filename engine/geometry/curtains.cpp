#include "engine/geometry/curtains.h"

#include <Eigen/Geometry>

#include "engine/geometry/error.h"

namespace sinew {

Curtains::Curtains(std::span<const Cut> cuts) {
  for (const Cut& cut : cuts) {
    bool finite = cut.depth.allFinite();
    for (const Vec3& p : cut.path) finite = finite && p.allFinite();
    if (!finite) throw InputError("cut: expected finite numbers, found others");
    for (std::size_t i = 1; i < cut.path.size(); ++i) {
      const Vec3 &a = cut.path[i - 1], &b = cut.path[i], side = b - a;
      const Vec3 normal = side.cross(cut.depth);
      const double square = normal.squaredNorm();
      if (!(square > 0)) continue;
      const Vec3 far[] = {b, a + cut.depth, b + cut.depth};
      Quad quad{a, normal, cut.depth.cross(normal) / square, normal.cross(side) / square, a, a};
      for (const Vec3& corner : far) {
        quad.min = quad.min.cwiseMin(corner);
        quad.max = quad.max.cwiseMax(corner);
      }
      // The box of a curtain along an axis is flat, and a crossing is found a rounding beside it.
      const Vec3 margin = Vec3::Constant(1e-9 * (quad.max - quad.min).norm());
      quad.min -= margin;
      quad.max += margin;
      quads_.push_back(quad);
    }
  }
}

bool Curtains::part(const Vec3& p, const Vec3& q) const {
  // Neighbouring parallelograms overlap by so much, or a segment could slip through where they meet.
  constexpr double border = 1e-9;
  for (const Quad& quad : quads_) {
    if ((p.cwiseMax(q).array() < quad.min.array()).any() || (p.cwiseMin(q).array() > quad.max.array()).any()) continue;
    // A side is a function of the point alone: rounding never puts one point on two sides.
    const double side_p = quad.normal.dot(p - quad.a), side_q = quad.normal.dot(q - quad.a);
    if ((side_p >= 0) == (side_q >= 0)) continue;
    const Vec3 x = p + side_p / (side_p - side_q) * (q - p) - quad.a;
    const double u = quad.u.dot(x), v = quad.v.dot(x);
    if (u >= -border && u <= 1 + border && v >= -border && v <= 1 + border) return true;
  }
  return false;
}

}  // namespace sinew
