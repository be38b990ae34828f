#include "engine/geometry/curtains.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "engine/geometry/error.h"
#include "engine/geometry/random.h"

namespace sinew {

namespace {

Vec3 random_point(std::uint64_t seed, std::uint64_t i) {
  return 2 * Vec3(random_unit(seed, 3 * i), random_unit(seed, 3 * i + 1), random_unit(seed, 3 * i + 2)) -
         Vec3::Constant(1);
}

/// A path over the unit square, 1 deep: the wall x = 0, |y| <= 1, |z| <= 0.5 in two pieces.
Cut wall() {
  return {{Vec3(0, -1, -0.5), Vec3(0, 0.25, -0.5), Vec3(0, 1, -0.5)}, Vec3(0, 0, 1)};
}

}  // namespace

TEST(Curtains, BarExactlyWhatPassesThrough) {
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Vec3 away(300, -70, 20);
  Cut turned = wall();
  for (Vec3& p : turned.path) p = turn * p + away;
  turned.depth = turn * turned.depth;
  const Curtains curtains(std::vector{turned});
  std::size_t barred = 0;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const Vec3 p = random_point(1, i), q = random_point(2, i);
    const Vec3 x = p + p.x() / (p.x() - q.x()) * (q - p);  // where the line meets the wall's plane
    const bool through = p.x() * q.x() < 0 && std::abs(x.y()) < 1 && std::abs(x.z()) < 0.5;
    barred += through ? 1 : 0;
    ASSERT_EQ(curtains.part(turn * p + away, turn * q + away), through) << i;
    ASSERT_EQ(curtains.part(turn * q + away, turn * p + away), through) << i;
  }
  EXPECT_GT(barred, 500u);
}

TEST(Curtains, HaveNoSlitsWhereTheirPiecesMeet) {
  // A zigzag, pierced exactly at its bends.
  Cut zigzag{{}, Vec3(0, 0.3, 1)};
  for (int i = 0; i < 40; ++i) zigzag.path.emplace_back(i / 7.0, i % 2 == 0 ? 0 : 0.1 + i / 300.0, 0);
  const Curtains curtains(std::vector{zigzag});
  for (std::size_t i = 1; i + 1 < zigzag.path.size(); ++i)
    for (const double v : {0.0, 0.1, 1.0 / 3, 0.9, 1.0}) {
      const Vec3 bend = zigzag.path[i] + v * zigzag.depth;
      EXPECT_TRUE(curtains.part(bend - Vec3(0, 0.5, 0), bend + Vec3(0, 0.5, 0))) << i << ' ' << v;
    }
}

TEST(Curtains, APointInACurtainIsOnOneSideOfIt) {
  const Curtains curtains(std::vector{wall()});
  for (const double y : {-1.0, -0.3, 0.25, 0.7}) {
    const Vec3 inside(0, y, 0.1);
    const bool one = curtains.part(inside, Vec3(1, y, 0)), other = curtains.part(inside, Vec3(-1, y, 0));
    EXPECT_NE(one, other) << y;
    EXPECT_FALSE(curtains.part(inside, inside));
  }
}

TEST(Curtains, WithoutAnAreaBarNothing) {
  const Vec3 z(0, 0, 1), p(-1, 0.1, 0.1), q(1, 0.1, 0.1);
  EXPECT_TRUE(Curtains(std::vector<Cut>{}).empty());
  EXPECT_FALSE(Curtains(std::vector<Cut>{}).part(p, q));
  const Cut flat[] = {{{}, z},
                      {{Vec3(0, 0, 0)}, z},
                      {{Vec3(0, 0, 0), Vec3(0, 0, 3)}, z},
                      {{Vec3(0, 1, 0), Vec3(0, 1, 0)}, z},
                      {{Vec3(0, -1, 0), Vec3(0, 1, 0)}, Vec3::Zero()}};
  EXPECT_TRUE(Curtains(flat).empty());
  Cut wrong = wall();
  wrong.path[1].y() = std::nan("");
  EXPECT_THROW(Curtains(std::vector{wrong}), InputError);
  wrong = wall();
  wrong.depth.x() = HUGE_VAL;
  EXPECT_THROW(Curtains(std::vector{wrong}), InputError);
}

}  // namespace sinew
