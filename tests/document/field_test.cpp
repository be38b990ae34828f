/// Fields: what an edit does at each point, as numbers.

#include "engine/document/field.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace sinew::document {

namespace {

/// Points that follow two maps, the first alone, both, the second alone; the last follows none.
LayerResult two_maps(const Affine& a, const Affine& b) {
  LayerResult out;
  auto weights = std::make_shared<SkinWeights>();
  weights->offsets = {0, 1, 3, 4, 4};
  weights->maps = {0, 0, 1, 1};
  weights->weights = {1, 0.25F, 0.75F, 1};
  out.weights = weights;
  out.pose = std::make_shared<const Pose>(Pose{a, b});
  out.map_energy = std::make_shared<const std::vector<double>>(std::vector<double>{2, 6});
  return out;
}

Affine affine(const Mat3& M, const Vec3& t) {
  Affine out;
  out << M, t;
  return out;
}

const std::vector<Vec3> rest{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};

}  // namespace

TEST(Field, TellsHowFarPointsWentOverAllLayers) {
  const LayerResult once = two_maps(affine(Mat3::Identity(), Vec3(0, 1, 0)), affine(Mat3::Identity(), Vec3(0, 3, 0)));
  const std::vector<LayerResult> twice{once, once};
  const Field field = field_of(FieldKind::Displacement, rest, twice);
  const double expected[] = {2, 5, 6, 0};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(field.values[i], expected[i], 1e-6);
  EXPECT_EQ(field.scale, Field::Scale::FromZero);
}

TEST(Field, TellsStretchWithItsSignAndRotationInDegrees) {
  const Mat3 turn = Eigen::AngleAxisd(std::numbers::pi / 3, Vec3(1, 2, 3).normalized()).toRotationMatrix();
  const Mat3 shorter = turn * Vec3(1, 0.8, 1.1).asDiagonal();
  const std::vector<LayerResult> layers{two_maps(affine(shorter, Vec3(5, 5, 5)), affine(turn, Vec3::Zero()))};
  const Field stretch = field_of(FieldKind::Stretch, rest, layers);
  EXPECT_NEAR(stretch.values[0], -20, 1e-4) << "0.8 is farther from 1 than 1.1";
  EXPECT_NEAR(stretch.values[2], 0, 1e-4);
  EXPECT_EQ(stretch.scale, Field::Scale::Signed);
  EXPECT_EQ(stretch.unit, " %");
  const Field rotation = field_of(FieldKind::Rotation, rest, layers);
  EXPECT_NEAR(rotation.values[0], 60, 1e-4);
  EXPECT_NEAR(rotation.values[2], 60, 1e-4);
  EXPECT_EQ(rotation.values[3], 0);
}

TEST(Field, RotationIsThatOfThePolarFactorWhateverTheMatrix) {
  std::mt19937 random(4);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 200; ++k) {
    const double degrees = 179.5 * k / 199;
    const Vec3 axis = Vec3(normal(random), normal(random), normal(random)).normalized();
    const Mat3 R = Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis).toRotationMatrix();
    const Vec3 stretches(std::exp(normal(random)), std::exp(normal(random)), std::exp(normal(random)));
    const Mat3 V = Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random))
                       .normalized()
                       .toRotationMatrix();
    EXPECT_NEAR(rotation_of(R * V * stretches.asDiagonal() * V.transpose()), degrees, 1e-6);
  }
  Mat3 flat = Mat3::Identity();
  flat(2, 2) = 0;
  EXPECT_NEAR(rotation_of(flat), 0, 1e-9);
  EXPECT_TRUE(std::isfinite(rotation_of(Mat3(Vec3(1, 1, -1).asDiagonal()))));
}

TEST(Field, BlendsTheEnergyOfMapsAndTellsTheInfluenceOfOne) {
  const std::vector<LayerResult> layers{two_maps(identity_map(), identity_map())};
  const Field energy = field_of(FieldKind::Energy, rest, layers),
              second = field_of(FieldKind::Influence, rest, layers, 1);
  const double energies[] = {2, 5, 6, 0}, influences[] = {0, 0.75, 1, 0};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(energy.values[i], energies[i], 1e-6);
    EXPECT_NEAR(second.values[i], influences[i], 1e-6);
  }
  const std::vector<Index> middle{1}, both{0, 1};
  EXPECT_EQ(strongest_map(*layers[0].weights, middle), 1U);
  EXPECT_EQ(strongest_map(*layers[0].weights, both), 0U);
}

TEST(Field, RangesArePercentilesAndSignedOnesHaveZeroInTheMiddle) {
  std::vector<float> values(1001);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i) - 200;
  EXPECT_EQ(usual_range(values, Field::Scale::Any), (ValueRange{-190, 790}));
  EXPECT_EQ(usual_range(values, Field::Scale::FromZero), (ValueRange{0, 790}));
  EXPECT_EQ(usual_range(values, Field::Scale::Signed), (ValueRange{-790, 790}));
  EXPECT_EQ(usual_range(values, Field::Scale::Any, true), (ValueRange{-790, 790}));
  EXPECT_EQ(extent_of(values), (ValueRange{-200, 800}));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(usual_range(std::vector<float>{nan, nan}, Field::Scale::Any), ValueRange{});
  EXPECT_EQ(extent_of(std::vector<float>{nan, 3, nan}), (ValueRange{3, 3}));
}

TEST(Field, PointsThatAreNotFiniteHaveNone) {
  std::vector<Vec3> broken = rest;
  broken[1].x() = std::nan("");
  const std::vector<LayerResult> layers{two_maps(identity_map(), identity_map())};
  const Field field = field_of(FieldKind::Displacement, broken, layers);
  EXPECT_TRUE(std::isnan(field.values[1]));
  EXPECT_EQ(field.values[0], 0);
}

}  // namespace sinew::document
