#include "engine/geometry/harmonics.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/splats.h"

namespace sinew {

namespace {

double value_along(std::span<const double> coefficients, const Vec3& d) {
  const std::array<double, 15> Y = harmonics_at(d);
  double sum = 0;
  for (std::size_t k = 0; k < coefficients.size(); ++k) sum += coefficients[k] * Y[k];
  return sum;
}

std::vector<double> random_coefficients(RandomSplats& random, int degree) {
  std::vector<double> c(static_cast<std::size_t>((degree + 1) * (degree + 1) - 1));
  for (double& x : c) x = random.value();
  return c;
}

}  // namespace

/// The polynomials of the test themselves: orthonormal over the sphere, by sums over many directions.
TEST(Harmonics, TheTestsOwnFunctionsAreOrthonormal) {
  Eigen::Matrix<double, 15, 15> G = Eigen::Matrix<double, 15, 15>::Zero();
  constexpr int rings = 60, spokes = 60;
  for (int a = 0; a < rings; ++a)
    for (int b = 0; b < spokes; ++b) {
      const double z = (2 * a + 1.0) / rings - 1, phi = 2 * std::numbers::pi * b / spokes, r = std::sqrt(1 - z * z);
      const std::array<double, 15> Y = harmonics_at({r * std::cos(phi), r * std::sin(phi), z});
      const Eigen::Map<const Eigen::Matrix<double, 15, 1>> y(Y.data());
      G += y * y.transpose() * (4 * std::numbers::pi / (rings * spokes));
    }
  EXPECT_LT((G - Eigen::Matrix<double, 15, 15>::Identity()).cwiseAbs().maxCoeff(), 5e-3);
}

TEST(Harmonics, ATurnedColourIsSeenAlongTheTurnedDirection) {
  RandomSplats random;
  for (int n = 0; n < 3000; ++n) {
    const int degree = 1 + n % 3;
    const Mat3 Q = random.rotation();
    const std::vector<double> before = random_coefficients(random, degree);
    std::vector<double> after = before;
    HarmonicsRotation(Q, degree).turn(after);
    for (int k = 0; k < 4; ++k) {
      const Vec3 d = random.direction();
      ASSERT_NEAR(value_along(after, Q * d), value_along(before, d), 1e-12) << "degree " << degree;
    }
  }
}

/// Each band by itself, about each axis: a defect in one band, sign or order cannot hide behind the others.
TEST(Harmonics, BandsDoNotMix) {
  RandomSplats random;
  for (std::size_t k = 0; k < 15; ++k)
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}) {
      std::vector<double> c(15, 0.0);
      c[k] = 1;
      const Mat3 Q = Eigen::AngleAxisd(0.7, axis).toRotationMatrix();
      HarmonicsRotation(Q, 3).turn(c);
      const auto same_band = [k](std::size_t other) { return (k < 3) == (other < 3) && (k < 8) == (other < 8); };
      for (std::size_t other = 0; other < 15; ++other) EXPECT_TRUE(same_band(other) || c[other] == 0);
      const Vec3 d = random.direction();
      EXPECT_NEAR(value_along(c, Q * d), harmonics_at(d)[k], 1e-13);
    }
}

TEST(Harmonics, TurnsFollowEachOther) {
  RandomSplats random;
  for (int n = 0; n < 500; ++n) {
    const Mat3 A = random.rotation(), B = random.rotation();
    std::vector<double> one = random_coefficients(random, 3), two = one;
    HarmonicsRotation(B * A, 3).turn(one);
    HarmonicsRotation(A, 3).turn(two);
    HarmonicsRotation(B, 3).turn(two);
    for (std::size_t k = 0; k < one.size(); ++k) ASSERT_NEAR(one[k], two[k], 1e-12);
  }
}

TEST(Harmonics, DegreeFollowsFromTheCount) {
  EXPECT_EQ(harmonics_degree(9), 1);
  EXPECT_EQ(harmonics_degree(24), 2);
  EXPECT_EQ(harmonics_degree(45), 3);
  for (const int count : {0, 3, 8, 15, 44, 72}) EXPECT_FALSE(harmonics_degree(count)) << count;
}

}  // namespace sinew
