#include "engine/geometry/triangle.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "engine/geometry/random.h"

namespace sinew {
namespace {

Vec3 random_point(std::uint64_t i) {
  return {random_unit(7, 3 * i), random_unit(7, 3 * i + 1), random_unit(7, 3 * i + 2)};
}

/// Of the places on a fine lattice of the triangle, corners and sides included.
double least_distance(const Vec3& p, const std::array<Vec3, 3>& t) {
  constexpr int steps = 60;
  double least = INFINITY;
  for (int i = 0; i <= steps; ++i)
    for (int j = 0; i + j <= steps; ++j) {
      const double u = static_cast<double>(i) / steps, v = static_cast<double>(j) / steps;
      least = std::min(least, ((1 - u - v) * t[0] + u * t[1] + v * t[2] - p).norm());
    }
  return least;
}

TEST(Triangle, TheNearestPointOfAnyTriangle) {
  for (std::uint64_t k = 0; k < 60; ++k) {
    std::array<Vec3, 3> t{random_point(4 * k), random_point(4 * k + 1), random_point(4 * k + 2)};
    if (k % 4 == 1) t[2] = t[0] + 0.3 * (t[1] - t[0]);  // on a line, the third corner between the others
    if (k % 4 == 2) t[2] = t[1];
    if (k % 8 == 3) t[1] = t[2] = t[0];
    const Vec3 p = 3 * random_point(4 * k + 3) - Vec3::Constant(1);
    const Vec3 w = nearest_in_triangle(p, t[0], t[1], t[2]);
    EXPECT_NEAR(w.sum(), 1, 1e-12);
    EXPECT_GE(w.minCoeff(), 0);
    const double distance = (w[0] * t[0] + w[1] * t[1] + w[2] * t[2] - p).norm(), least = least_distance(p, t);
    EXPECT_LE(distance, least + 1e-12) << k;
    EXPECT_GE(distance, least - 0.02) << k;
  }
}

TEST(Triangle, CoordinatesGiveThePointAgain) {
  for (std::uint64_t k = 0; k < 20; ++k) {
    const Vec3 a = random_point(4 * k), b = random_point(4 * k + 1), c = random_point(4 * k + 2),
               p = 3 * random_point(4 * k + 3);
    const TriangleCoordinates at = coordinates_in(p, a, b, c);
    const Vec3 n = (b - a).cross(c - a).normalized();
    const Vec3 again = at.weights[0] * a + at.weights[1] * b + at.weights[2] * c + at.height * n;
    EXPECT_LT((again - p).norm(), 1e-9) << k;
  }
}

TEST(Triangle, WithoutAreaCoordinatesAreThoseOfTheNearestCorner) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(2, 0, 0);
  const TriangleCoordinates at = coordinates_in({1.9, 1, 0}, a, b, c);
  EXPECT_EQ(at.weights, Vec3::UnitZ());
  EXPECT_EQ(at.height, 0);
}

}  // namespace
}  // namespace sinew
