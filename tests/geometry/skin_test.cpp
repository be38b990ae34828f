#include "engine/geometry/skin.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <random>

#include "engine/geometry/parallel.h"

namespace sinew {

namespace {

struct Fixture {
  std::mt19937 random{11};
  Shape shape;
  SkinWeights weights;
  Pose pose;

  double value() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  Vec3 vector() { return {value(), value(), value()}; }

  explicit Fixture(std::size_t n = 500, std::size_t maps = 9) {
    for (std::size_t j = 0; j < maps; ++j) {
      Affine map;
      map << Mat3::Identity() + 0.3 * (Mat3() << vector(), vector(), vector()).finished(), vector();
      pose.push_back(map);
    }
    for (std::size_t i = 0; i < n; ++i) {
      shape.positions.push_back(vector());
      const std::size_t row = i % 6;  // rows of any length, empty ones too
      for (std::size_t e = 0; e < row; ++e) {
        weights.maps.push_back(static_cast<std::uint32_t>(random() % maps));
        weights.weights.push_back(1.0F / static_cast<float>(row));
      }
      weights.offsets.push_back(weights.maps.size());
    }
  }
};

Attribute attribute_of(const char* name, Kind kind, Type type, std::span<const Vec3> rows) {
  Attribute a;
  a.name = name;
  a.kind = kind;
  a.type = type;
  a.components = 3;
  a.values.resize(rows.size() * 3 * size_of(type));
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (int c = 0; c < 3; ++c) a.set_number(i, c, rows[i][c]);
  return a;
}

Vec3 row(const Attribute& a, std::size_t i) {
  return {a.number(i, 0), a.number(i, 1), a.number(i, 2)};
}

}  // namespace

TEST(Skin, IsTheWeightedSumOfTheMaps) {
  Fixture f;
  std::vector<Vec3> out(f.shape.size());
  skin_points(f.weights, f.pose, f.shape.positions, out);
  for (std::size_t i = 0; i < out.size(); ++i) {
    Vec3 expected = f.weights.offsets[i] == f.weights.offsets[i + 1] ? f.shape.positions[i] : Vec3(Vec3::Zero());
    for (std::uint64_t e = f.weights.offsets[i]; e < f.weights.offsets[i + 1]; ++e)
      expected +=
          static_cast<double>(f.weights.weights[e]) * (f.pose[f.weights.maps[e]] * f.shape.positions[i].homogeneous());
    EXPECT_LT((out[i] - expected).norm(), 1e-6);
  }
}

TEST(Skin, IdentityMapsKeepEveryBit) {
  Fixture f;
  f.shape.positions[3] = Vec3(std::nan(""), 1, 2);
  f.shape.attributes.push_back(attribute_of("normal", Kind::Normal, Type::Float32, f.shape.positions));
  f.shape.attributes.push_back(attribute_of("velocity", Kind::Vector, Type::Float64, f.shape.positions));
  const Shape out = skin(f.shape, f.weights, Pose(f.pose.size(), identity_map()));
  EXPECT_EQ(std::memcmp(out.positions.data(), f.shape.positions.data(), out.size() * sizeof(Vec3)), 0);
  EXPECT_EQ(out.attributes, f.shape.attributes);
}

TEST(Skin, NormalsStayPerpendicularToTheBentSurface) {
  Fixture f;
  for (int i = 0; i < 200; ++i) {
    const Mat3 M = (Mat3() << f.vector(), f.vector(), f.vector()).finished();
    if (std::abs(M.determinant()) < 0.05) continue;
    const Vec3 a = f.vector(), b = f.vector(), n = a.cross(b);
    const Vec3 turned = skin_normal(M, n);
    EXPECT_NEAR(turned.normalized().dot((M * a).normalized()), 0, 1e-10);
    EXPECT_NEAR(turned.normalized().dot((M * b).normalized()), 0, 1e-10);
    EXPECT_NEAR(turned.norm(), n.norm(), 1e-12);
    EXPECT_GT(turned.dot((M * a).cross(M * b)), 0);  // the same side of the surface, mirrored or not
  }
  EXPECT_EQ(skin_normal(Mat3::Zero(), Vec3(0, 0, 2)), Vec3(0, 0, 2));
}

TEST(Skin, EachKindBendsInItsWay) {
  Shape shape;
  shape.origin = Vec3(100, 200, 300);
  shape.positions = {Vec3(1, 0, 0), Vec3(0, 1, 0)};
  const std::vector<Vec3> rows = {Vec3(0, 0, 1), Vec3(3, 4, 0)};
  for (const Kind kind : {Kind::Scalar, Kind::Color, Kind::Id, Kind::Vector, Kind::Normal, Kind::Point})
    shape.attributes.push_back(attribute_of(name_of(kind), kind, Type::Float64, rows));
  SkinWeights weights;
  weights.offsets = {0, 1, 2};
  weights.maps = {0, 0};
  weights.weights = {1, 1};
  Affine map;
  map << Eigen::AngleAxisd(std::acos(0.0), Vec3::UnitX()).toRotationMatrix() * 2, Vec3(5, 6, 7);  // z -> -2 y
  const Shape out = skin(shape, weights, {map});
  for (const char* name : {"scalar", "color", "id"}) EXPECT_EQ(*out.find(name), *shape.find(name));
  EXPECT_LT((row(*out.find("vector"), 0) - Vec3(0, -2, 0)).norm(), 1e-12);
  EXPECT_LT((row(*out.find("normal"), 0) - Vec3(0, -1, 0)).norm(), 1e-12);
  EXPECT_LT((row(*out.find("normal"), 1) - Vec3(3, 0, 4)).norm(), 1e-12);
  // A point is in the file's coordinates: the map acts relative to the origin.
  const Vec3 p = map * (rows[1] - shape.origin).homogeneous() + shape.origin;
  EXPECT_LT((row(*out.find("point"), 1) - p).norm(), 1e-9);
}

TEST(Skin, AValueOfSeveralPointsFollowsTheirMean) {
  Shape shape;
  shape.positions.assign(3, Vec3::Zero());
  Attribute normal =
      attribute_of("normal", Kind::Normal, Type::Float32, std::vector<Vec3>{Vec3(0, 0, 1), Vec3(0, 0, 1)});
  normal.point_offsets = {0, 2, 2};  // one of points 1 and 2, one of none
  normal.points = {1, 2};
  shape.attributes.push_back(normal);
  SkinWeights weights;
  weights.offsets = {0, 1, 2, 3};
  weights.maps = {0, 1, 2};
  weights.weights = {1, 1, 1};
  Pose pose(3, identity_map());
  pose[1].leftCols<3>() = Eigen::AngleAxisd(0.2, Vec3::UnitX()).toRotationMatrix();
  pose[2].leftCols<3>() = Eigen::AngleAxisd(0.4, Vec3::UnitX()).toRotationMatrix();
  const Shape out = skin(shape, weights, pose);
  EXPECT_LT((row(out.attributes[0], 0) - Eigen::AngleAxisd(0.3, Vec3::UnitX()) * Vec3::UnitZ()).norm(), 1e-6);
  EXPECT_EQ(row(out.attributes[0], 1), Vec3::UnitZ());
}

TEST(Skin, TheSameBitsForAnyNumberOfThreads) {
  Fixture f(20000);
  std::vector<std::vector<Vec3>> results;
  for (const int threads : {1, 3}) {
    set_thread_count(threads);
    std::vector<Vec3> out(f.shape.size());
    skin_points(f.weights, f.pose, f.shape.positions, out);
    results.push_back(out);
  }
  set_thread_count(2);
  EXPECT_EQ(results[0], results[1]);
}

TEST(Skin, BlendedMatricesAreThoseOfThePoints) {
  Fixture f(30);
  std::vector<Mat3> M(10);
  blend_matrices(f.weights, f.pose, 12, M);
  constexpr double h = 1e-6;
  for (std::size_t i = 0; i < M.size(); ++i) {
    Mat3 J;
    for (int c = 0; c < 3; ++c) {
      std::vector<Vec3> plus = f.shape.positions, minus = f.shape.positions;
      plus[12 + i][c] += h;
      minus[12 + i][c] -= h;
      skin_points(f.weights, f.pose, plus, plus);
      skin_points(f.weights, f.pose, minus, minus);
      J.col(c) = (plus[12 + i] - minus[12 + i]) / (2 * h);
    }
    EXPECT_LT((M[i] - J).norm(), 1e-8);
  }
}

}  // namespace sinew
