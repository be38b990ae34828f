#include "deformers/polygon_ears.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

namespace sinew {

namespace {

constexpr std::size_t longest_cut = 2000;  // ears take n^2 steps and more

/// Twice the vector area.
Vec3 area_vector(std::span<const Vec3> polygon) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t k = 1; k + 1 < polygon.size(); ++k)
    sum += (polygon[k] - polygon[0]).cross(polygon[k + 1] - polygon[0]);
  return sum;
}

struct Ear {
  const Vec3 &a, &b, &c;
  const Vec3& normal;

  double area() const { return (b - a).cross(c - b).dot(normal); }
  /// The sine of its smallest angle, about; 0 where it is no ear.
  double quality() const {
    const double x = (b - a).squaredNorm(), y = (c - b).squaredNorm(), z = (a - c).squaredNorm();
    const double longest = std::max({x, y, z});
    return longest > 0 ? area() / longest : 0;
  }
  bool holds(const Vec3& p) const {
    return (b - a).cross(p - a).dot(normal) >= 0 && (c - b).cross(p - b).dot(normal) >= 0 &&
           (a - c).cross(p - c).dot(normal) >= 0;
  }
};

}  // namespace

std::vector<std::array<Index, 3>> polygon_ears(std::span<const Vec3> polygon,
                                               const std::function<bool(Index, Index)>& may_join) {
  std::vector<std::array<Index, 3>> triangles;
  std::vector<Index> left(polygon.size());
  std::iota(left.begin(), left.end(), Index{0});
  const Vec3 normal = area_vector(polygon).normalized();
  const auto ear = [&](std::size_t k) {
    const std::size_t n = left.size();
    return Ear{polygon[left[(k + n - 1) % n]], polygon[left[k]], polygon[left[(k + 1) % n]], normal};
  };
  const auto free = [&](std::size_t k) {
    const std::size_t n = left.size();
    if (may_join && !may_join(left[(k + n - 1) % n], left[(k + 1) % n])) return false;
    const Ear tip = ear(k);
    for (std::size_t i = 0; i < left.size(); ++i) {
      const Vec3& p = polygon[left[i]];
      if (p != tip.a && p != tip.b && p != tip.c && tip.holds(p)) return false;
    }
    return true;
  };
  while (left.size() > 3 && polygon.size() <= longest_cut) {
    std::size_t best = left.size();
    double quality = 1e-12;
    for (std::size_t k = 0; k < left.size(); ++k)
      if (const double q = ear(k).quality(); q > quality && free(k)) {
        best = k;
        quality = q;
      }
    if (best == left.size()) break;
    const std::size_t n = left.size();
    triangles.push_back({left[(best + n - 1) % n], left[best], left[(best + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
  }
  for (std::size_t k = 1; k + 1 < left.size(); ++k) triangles.push_back({left[0], left[k], left[k + 1]});
  return triangles;
}

}  // namespace sinew
