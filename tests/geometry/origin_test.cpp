#include <gtest/gtest.h>

#include "engine/geometry/shape.h"

namespace sinew {
namespace {

Shape two_points(double a, double b) {
  Shape shape;
  shape.positions = {Vec3(a, 0, 0), Vec3(b, 0, 0)};
  return shape;
}

TEST(Origin, IsZeroWhereThePointsLieAround) {
  Shape shape = two_points(-1, 2);
  set_origin(shape);
  EXPECT_EQ(shape.origin, Vec3::Zero());
}

TEST(Origin, GivesEveryCoordinateBackExactlyInAnyUnit) {
  for (const double unit : {1.0, 1e-9, 1e-15, 1e-46, 1e-290, 1e-310, 1e9, 1e290, 1e307}) {
    const double a = 5.400000123 * unit, b = 5.400001456 * unit;
    Shape shape = two_points(a, b);
    set_origin(shape);
    ASSERT_TRUE(shape.origin.allFinite()) << unit;
    EXPECT_EQ(shape.positions[0].x() + shape.origin.x(), a) << unit;
    EXPECT_EQ(shape.positions[1].x() + shape.origin.x(), b) << unit;
    const bool ordinary = unit > 1e-290 && unit < 1e290;
    EXPECT_TRUE(!ordinary || std::abs(shape.positions[0].x()) < 1e-5 * a) << unit;
  }
}

TEST(Origin, LargestNumbersAreNoTrap) {
  Shape shape = two_points(1.7e308, 1.75e308);
  set_origin(shape);
  EXPECT_TRUE(shape.origin.allFinite());
}

}  // namespace
}  // namespace sinew
