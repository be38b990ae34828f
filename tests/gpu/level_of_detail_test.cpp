#include "engine/gpu/level_of_detail.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace sinew::gpu {
namespace {

/// A line of points, dense at one end.
std::vector<Eigen::Vector3d> uneven(std::size_t count) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(std::pow(static_cast<double>(i) / static_cast<double>(count), 4), 0, 0);
  return points;
}

TEST(LevelOfDetail, IsAPermutation) {
  std::vector<Eigen::Vector3d> points = uneven(1000);
  points[17].x() = std::nan("");
  const std::vector<std::uint32_t> order = progressive_order(points);
  EXPECT_EQ(std::set<std::uint32_t>(order.begin(), order.end()).size(), points.size());
  EXPECT_EQ(order.back(), 17u);
  EXPECT_EQ(progressive_order(points), order);
  EXPECT_TRUE(progressive_order({}).empty());
  EXPECT_EQ(progressive_order(std::vector<Eigen::Vector3d>(3, {1, 2, 3})).size(), 3u);
}

TEST(LevelOfDetail, EveryBeginningIsEven) {
  const std::vector<Eigen::Vector3d> points = uneven(20'000);
  const std::vector<std::uint32_t> order = progressive_order(points);
  for (const std::size_t count : {32u, 128u, 400u}) {
    // The part of the line that has no point within two even spacings.
    std::set<int> cells;
    const int wanted = static_cast<int>(count) / 4;
    for (std::size_t k = 0; k < count; ++k) cells.insert(static_cast<int>(points[order[k]].x() * wanted));
    EXPECT_GT(static_cast<int>(cells.size()), wanted * 9 / 10) << count;
  }
}

TEST(LevelOfDetail, TheCountFollowsTheTime) {
  EXPECT_EQ(next_count(10'000, 20, 10, 1000, 100'000), 5'000u);
  EXPECT_EQ(next_count(10'000, 1, 10, 1000, 100'000), 20'000u);
  EXPECT_EQ(next_count(1500, 100, 10, 1000, 100'000), 1000u);
  EXPECT_EQ(next_count(90'000, 1, 10, 1000, 100'000), 100'000u);
  EXPECT_EQ(next_count(10, 100, 10, 1000, 20), 20u);
}

}  // namespace
}  // namespace sinew::gpu
