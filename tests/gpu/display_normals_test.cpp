#include "engine/gpu/display_normals.h"

#include <cmath>

#include "tests/gpu/gpu_test.h"

namespace sinew::gpu {
namespace {

TEST(DisplayNormals, OfASphereAreItsRadii) {
  std::vector<Eigen::Vector3d> points, normals;
  sphere(5000, points, normals);
  points[77].x() = std::nan("");
  const std::vector<Eigen::Vector3d> found = display_normals(points);
  ASSERT_EQ(found.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i == 77)
      EXPECT_EQ(found[i], Eigen::Vector3d(0, 0, 0));
    else
      EXPECT_GT(std::abs(found[i].dot(normals[i])), 0.999) << i;
  }
}

TEST(DisplayNormals, OfTooFewPointsAreZero) {
  EXPECT_TRUE(display_normals({}).empty());
  for (const Eigen::Vector3d& n : display_normals(std::vector<Eigen::Vector3d>{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}))
    EXPECT_EQ(n, Eigen::Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace sinew::gpu
