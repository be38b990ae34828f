#include "engine/geometry/gaussian.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "engine/geometry/rotation.h"
#include "tests/splats.h"

namespace sinew {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Gaussian random_gaussian(RandomSplats& random) {
  return {Eigen::Vector4d(random.value(), random.value(), random.value(), random.value()), 3 * random.vector()};
}

Gaussian bent(const Gaussian& gaussian, const Mat3& J) {
  return bent(gaussian, J, nearest_rotation(J));
}

bool same(const Gaussian& a, const Gaussian& b) {
  return std::memcmp(a.quaternion.data(), b.quaternion.data(), sizeof(a.quaternion)) == 0 &&
         std::memcmp(a.log_scales.data(), b.log_scales.data(), sizeof(a.log_scales)) == 0;
}

}  // namespace

TEST(Gaussian, CovarianceIsThatOfTheDefinition) {
  RandomSplats random;
  for (int n = 0; n < 100; ++n) {
    const Gaussian g = random_gaussian(random);
    const Mat3 R = RandomSplats::matrix_of(g.quaternion);
    const Vec3 variance(std::exp(2 * g.log_scales[0]), std::exp(2 * g.log_scales[1]), std::exp(2 * g.log_scales[2]));
    const Mat3 S = R * variance.asDiagonal() * R.transpose();
    EXPECT_LT((covariance(g) - S).norm(), 1e-12 * S.norm());
  }
}

TEST(Gaussian, CovarianceFollowsAnyMap) {
  RandomSplats random;
  for (int n = 0; n < 2000; ++n) {
    const Gaussian g = random_gaussian(random);
    const Mat3 J = 2 * random.matrix(), S = J * covariance(g) * J.transpose();
    const Gaussian out = bent(g, J);
    ASSERT_LT((covariance(out) - S).norm(), 1e-11 * S.norm()) << J;
    ASSERT_NEAR(out.quaternion.norm(), g.quaternion.norm(), 1e-12);
    ASSERT_GE(out.quaternion.dot(g.quaternion), 0);
  }
}

/// A flat Gaussian, 10^-9 as thick as wide: its square loses the thickness, J S J^T in doubles has it to no digit.
TEST(Gaussian, AThinOneKeepsItsThickness) {
  RandomSplats random;
  for (int n = 0; n < 500; ++n) {
    Gaussian g{Eigen::Vector4d(random.value(), random.value(), random.value(), random.value()), Vec3(0.3, 0.1, -21)};
    Mat3 J = Mat3::Identity() + 0.4 * random.matrix();
    if (std::abs(J.determinant()) < 0.1) continue;
    const Gaussian out = bent(g, J);
    // The product of the axes is the volume, which J scales by its determinant.
    EXPECT_NEAR(out.log_scales.sum(), g.log_scales.sum() + std::log(std::abs(J.determinant())), 1e-9);
    // The thin axis stays the normal of the disc.
    const Vec3 normal = RandomSplats::matrix_of(g.quaternion).col(2);
    const Vec3 turned = J.inverse().transpose() * normal;
    EXPECT_NEAR(std::abs(RandomSplats::matrix_of(out.quaternion).col(2).dot(turned.normalized())), 1, 1e-9);
  }
}

TEST(Gaussian, ARigidMotionTurnsTheQuaternionAndKeepsTheScales) {
  RandomSplats random;
  for (int n = 0; n < 500; ++n) {
    const Gaussian g = random_gaussian(random);
    const Mat3 Q = random.rotation();
    const Gaussian out = bent(g, Q);
    EXPECT_LT((out.log_scales - g.log_scales).norm(), 1e-12);
    EXPECT_LT((RandomSplats::matrix_of(out.quaternion) - Q * RandomSplats::matrix_of(g.quaternion)).norm(), 1e-12);
  }
}

TEST(Gaussian, ASmallBendChangesLittle) {
  RandomSplats random;
  for (int n = 0; n < 500; ++n) {
    Gaussian g = random_gaussian(random);
    g.quaternion.normalize();
    g.log_scales = Vec3(0.5, 0, -0.5) + 0.1 * random.vector();
    const Mat3 J = Mat3::Identity() + 1e-4 * random.matrix();
    const Gaussian out = bent(g, J);
    EXPECT_LT((out.log_scales - g.log_scales).norm(), 1e-3);
    EXPECT_LT((out.quaternion - g.quaternion).norm(), 1e-3);
  }
}

TEST(Gaussian, AMirrorGivesARotation) {
  RandomSplats random;
  const Mat3 mirror = Vec3(-1, 1, 1).asDiagonal();
  for (int n = 0; n < 100; ++n) {
    const Gaussian g = random_gaussian(random), out = bent(g, mirror);
    const Mat3 S = mirror * covariance(g) * mirror;
    EXPECT_LT((covariance(out) - S).norm(), 1e-12 * S.norm());
    EXPECT_TRUE(out.quaternion.allFinite());
  }
}

TEST(Gaussian, WithoutThicknessItStaysADisc) {
  RandomSplats random;
  for (const double thin : {-infinity, -1000.0}) {
    const Gaussian g{Eigen::Vector4d(2, 0, 0, 0), Vec3(0, -0.3, thin)};
    const Mat3 J = Mat3::Identity() + 0.3 * random.matrix();
    const Gaussian out = bent(g, J);
    const Mat3 S = J * covariance(g) * J.transpose();
    EXPECT_LT((covariance(out) - S).norm(), 1e-12 * S.norm());
    EXPECT_EQ(out.log_scales[2], thin);
  }
  const Gaussian needle{Eigen::Vector4d(1, 0, 0, 0), Vec3(-infinity, 1, -infinity)};
  const Gaussian out = bent(needle, Mat3(2 * random.rotation()));
  EXPECT_NEAR(out.log_scales[1], 1 + std::log(2), 1e-12);
  EXPECT_EQ(out.log_scales[0], -infinity);
  EXPECT_TRUE(out.quaternion.allFinite());
}

TEST(Gaussian, ASingularMapFlattensToALimit) {
  const Gaussian g{Eigen::Vector4d(1, 0, 0, 0), Vec3(1, 2, 3)};
  const Gaussian out = bent(g, Mat3(Vec3(1, 0, 1).asDiagonal()));
  EXPECT_NEAR(out.log_scales[1], 3 + std::log(1e-15), 1e-12);
  EXPECT_NEAR(out.log_scales[0], 1, 1e-12);
  EXPECT_NEAR(out.log_scales[2], 3, 1e-12);
}

TEST(Gaussian, WhatIsNoEllipsoidStaysAsItWas) {
  const Mat3 J = Vec3(1, 2, 3).asDiagonal();
  const Eigen::Vector4d q(1, 0, 0, 0);
  const Gaussian odd[] = {{Eigen::Vector4d::Zero(), Vec3(0, 0, 0)},
                          {Eigen::Vector4d(1, std::nan(""), 0, 0), Vec3(0, 0, 0)},
                          {Eigen::Vector4d(1, infinity, 0, 0), Vec3(0, 0, 0)},
                          {q, Vec3(0, std::nan(""), 0)},
                          {q, Vec3(0, infinity, 0)},
                          {q, Vec3(-infinity, -infinity, -infinity)}};
  for (const Gaussian& g : odd) EXPECT_TRUE(same(bent(g, J), g));
  const Gaussian good{q, Vec3(0, 1, 2)};
  EXPECT_TRUE(same(bent(good, Mat3(Mat3::Zero())), good));
  EXPECT_TRUE(same(bent(good, Mat3(Mat3::Constant(std::nan(""))), Mat3::Identity()), good));
}

}  // namespace sinew
