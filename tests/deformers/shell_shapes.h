#pragma once
/// Small surfaces and their poses, for tests of shells.

#include <Eigen/Geometry>
#include <cmath>

#include "apps/samples/meshes.h"
#include "engine/geometry/deformer.h"
#include "engine/geometry/skin.h"

namespace sinew::test {

inline std::shared_ptr<const Shape> small_cylinder() {
  return std::make_shared<const Shape>(samples::cylinder(16, 2, 30));
}

template <class Map>
std::shared_ptr<const Shape> mapped(const Shape& shape, const Map& map) {
  auto out = std::make_shared<Shape>(shape);
  for (Vec3& p : out->positions) p = map(p);
  return out;
}

/// Bent along an arc of `degrees` in the plane of x and y, from y0 upwards over a length: what is above goes straight
/// on.
struct Bend {
  double degrees = 90, y0 = 0.3, length = 0.5;
  Vec3 operator()(const Vec3& p) const {
    const double total = degrees * M_PI / 180, s = std::clamp((p.y() - y0) / length, 0.0, 1.0), a = s * total;
    if (std::abs(total) < 1e-12 || s == 0) return p;
    const double r = length / total, beyond = std::max(0.0, p.y() - y0 - length);
    const Vec3 spine(r * (1 - std::cos(a)), y0 + r * std::sin(a), 0), along(std::sin(a), std::cos(a), 0),
        across(std::cos(a), -std::sin(a), 0);
    return spine + p.x() * across + Vec3(0, 0, p.z()) + beyond * along;
  }
};

inline std::vector<Vec3> bent(const Shape& rest, const Deformer& deformer) {
  return skin(rest, deformer.weights(), deformer.pose()).positions;
}

/// Greatest distance of corresponding points, after the best rigid motion where `fitted`.
inline double distance(std::span<const Vec3> a, std::span<const Vec3> b) {
  double out = 0;
  for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, (a[i] - b[i]).norm());
  return out;
}

/// Points of the cylinder's ends: below and above.
struct Ends {
  std::vector<Index> low, high;
};
inline Ends ends_of(const Shape& shape, double low = 0.06, double high = 1.09) {
  Ends out;
  for (Index i = 0; i < shape.size(); ++i) {
    if (shape.positions[i].y() < low) out.low.push_back(i);
    if (shape.positions[i].y() > high) out.high.push_back(i);
  }
  return out;
}

template <class Map>
Constraints moved_end(const Shape& shape, const Map& map) {
  const Ends ends = ends_of(shape);
  Constraints out;
  out.fixed = ends.low;
  Handle handle;
  handle.points = ends.high;
  for (const Index i : handle.points) handle.targets.push_back(map(shape.positions[i]));
  out.handles.push_back(std::move(handle));
  return out;
}

}  // namespace sinew::test
