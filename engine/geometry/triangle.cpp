#include "engine/geometry/triangle.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sinew {

namespace {

/// Of sides u and v, with n = u x v: too thin for coordinates in it.
bool is_flat(const Vec3& u, const Vec3& v, const Vec3& n) {
  const double longest = std::max(u.squaredNorm(), v.squaredNorm());
  return !(n.squaredNorm() > 1e-24 * longest * longest);
}

}  // namespace

TriangleCoordinates coordinates_in(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, v = c - a, n = u.cross(v);
  if (is_flat(u, v, n)) {
    const double da = (p - a).squaredNorm(), db = (p - b).squaredNorm(), dc = (p - c).squaredNorm();
    return {da <= db && da <= dc ? Vec3::UnitX() : db <= dc ? Vec3::UnitY() : Vec3::UnitZ(), 0};
  }
  const double square = n.squaredNorm();
  const Vec3 w = p - a;
  TriangleCoordinates out;
  out.weights.y() = w.cross(v).dot(n) / square;
  out.weights.z() = u.cross(w).dot(n) / square;
  out.weights.x() = 1 - out.weights.y() - out.weights.z();
  out.height = w.dot(n) / std::sqrt(square);
  return out;
}

Vec3 nearest_in_triangle(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  if (!is_flat(b - a, c - a, (b - a).cross(c - a))) {
    const Vec3 inside = coordinates_in(p, a, b, c).weights;
    if (inside.minCoeff() >= 0) return inside;
  }
  // On the nearest of the three sides.
  const Vec3* corners[] = {&a, &b, &c};
  Vec3 best = Vec3::UnitX();
  double least = INFINITY;
  for (int k = 0; k < 3; ++k) {
    const Vec3 &u = *corners[k], &v = *corners[(k + 1) % 3];
    const double square = (v - u).squaredNorm();
    const double s = square > 0 ? std::clamp((p - u).dot(v - u) / square, 0.0, 1.0) : 0;
    const double distance = (p - u - s * (v - u)).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    best.setZero();
    best[k] = 1 - s;
    best[(k + 1) % 3] = s;
  }
  return best;
}

}  // namespace sinew
