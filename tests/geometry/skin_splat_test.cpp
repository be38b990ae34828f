/// Attributes that bend by the derivative of the map: vectors, velocities, Gaussians, spherical harmonics. The maps and
/// weights here are functions of space and time made up for the test; splat_bend_test.cpp has those of a real graph.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include "engine/geometry/parallel.h"
#include "engine/geometry/rotation.h"
#include "engine/geometry/skin.h"
#include "tests/splats.h"

namespace sinew {

namespace {

/// Three maps whose weights are smooth functions of space: exp(-|p - g_j|^2), divided by their sum.
struct Field {
  RandomSplats random{9};
  std::vector<Vec3> centres;
  Pose pose, rate;
  Vec3 origin = Vec3(3, -2, 1);

  Field() {
    for (int j = 0; j < 3; ++j) {
      centres.push_back(random.vector());
      Affine map, change;
      map << Mat3::Identity() + 0.3 * random.matrix(), random.vector();
      change << random.matrix(), random.vector();
      pose.push_back(map);
      rate.push_back(change);
    }
  }

  SkinWeights bind(std::span<const Vec3> points, bool gradients = true) const {
    SkinWeights out;
    for (const Vec3& p : points) {
      double sum = 0;
      Vec3 sum_gradient = Vec3::Zero();
      std::vector<double> w;
      std::vector<Vec3> gradient;
      for (const Vec3& g : centres) {
        w.push_back(std::exp(-(p - g).squaredNorm()));
        gradient.push_back(-2 * w.back() * (p - g));
        sum += w.back();
        sum_gradient += gradient.back();
      }
      for (std::size_t j = 0; j < centres.size(); ++j) {
        out.maps.push_back(static_cast<std::uint32_t>(j));
        out.weights.push_back(static_cast<float>(w[j] / sum));
        if (gradients) out.gradients.push_back(((gradient[j] - w[j] / sum * sum_gradient) / sum).cast<float>());
      }
      out.offsets.push_back(out.maps.size());
    }
    return out;
  }

  /// The bent place of p, in doubles throughout.
  Vec3 bent(const Vec3& p, double time = 0) const {
    double sum = 0;
    Vec3 out = Vec3::Zero();
    for (std::size_t j = 0; j < centres.size(); ++j) {
      const double w = std::exp(-(p - centres[j]).squaredNorm());
      out += w * ((pose[j] + time * rate[j]) * p.homogeneous());
      sum += w;
    }
    return out / sum;
  }

  Mat3 derivative(const Vec3& p) const {
    constexpr double h = 1e-5;
    Mat3 J;
    for (int c = 0; c < 3; ++c) J.col(c) = (bent(p + h * Vec3::Unit(c)) - bent(p - h * Vec3::Unit(c))) / (2 * h);
    return J;
  }

  Shape shape(std::size_t n) {
    Shape out;
    out.origin = origin;
    for (std::size_t i = 0; i < n; ++i) out.positions.push_back(random.vector());
    return out;
  }
};

Vec3 row(const Attribute& a, std::size_t i) {
  return {a.number(i, 0), a.number(i, 1), a.number(i, 2)};
}

void fill(Attribute& a, RandomSplats& random) {
  for (std::size_t i = 0; i < a.count(); ++i)
    for (int c = 0; c < a.components; ++c) a.set_number(i, c, random.value());
}

/// Largest relative error of the covariances and of the colours seen along co-rotated directions.
std::pair<double, double> splat_errors(const Field& field, const Shape& rest, const Shape& bent) {
  RandomSplats random(3);
  double covariance = 0, colour = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Mat3 J = field.derivative(rest.positions[i]);
    const Mat3 S = J * covariance_at(rest, i) * J.transpose();
    covariance = std::max(covariance, (covariance_at(bent, i) - S).norm() / S.norm());
    const Vec3 d = random.direction();
    const Mat3 Q = nearest_rotation(J);
    colour = std::max(colour, (colour_at(bent, i, Q * d) - colour_at(rest, i, d)).norm());
  }
  return {covariance, colour};
}

}  // namespace

TEST(SkinSplat, CovarianceAndColourFollowTheDerivative) {
  for (int degree = 1; degree <= 3; ++degree) {
    Field field;
    Shape rest = field.shape(400);
    add_splats(rest, 0.01, degree);
    const Shape bent = skin(rest, field.bind(rest.positions), field.pose);
    const auto [covariance, colour] = splat_errors(field, rest, bent);
    EXPECT_LT(covariance, 1e-5);
    EXPECT_LT(colour, 1e-5);
    EXPECT_EQ(*bent.find("opacity"), *rest.find("opacity"));
    EXPECT_EQ(*bent.find("f_dc"), *rest.find("f_dc"));
  }
}

TEST(SkinSplat, TheCheckSeesPlantedDefects) {
  Field field;
  Shape rest = field.shape(400);
  add_splats(rest, 0.01, 3);
  // The blended matrix instead of the derivative.
  const auto blended = splat_errors(field, rest, skin(rest, field.bind(rest.positions, false), field.pose));
  EXPECT_GT(blended.first, 0.1);
  EXPECT_GT(blended.second, 0.1);
  // Colours that are not turned.
  Shape unturned = skin(rest, field.bind(rest.positions), field.pose);
  *unturned.find("f_rest") = *rest.find("f_rest");
  EXPECT_GT(splat_errors(field, rest, unturned).second, 0.1);
}

TEST(SkinSplat, VectorsFollowTheDerivative) {
  Field field;
  Shape rest = field.shape(300);
  fill(add_attribute(rest, "v", Kind::Vector, Type::Float64, 3), field.random);
  const Shape bent = skin(rest, field.bind(rest.positions), field.pose);
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Vec3 v = row(rest.attributes[0], i), expected = field.derivative(rest.positions[i]) * v;
    EXPECT_LT((row(bent.attributes[0], i) - expected).norm(), 1e-5);
  }
}

/// A point that moves with v, under maps that change: its bent place a moment later and earlier.
TEST(SkinSplat, VelocitiesAreThoseOfTheBentPoints) {
  Field field;
  Shape rest = field.shape(300);
  fill(add_attribute(rest, "v", Kind::Velocity, Type::Float64, 3), field.random);
  const SkinWeights weights = field.bind(rest.positions);
  const Shape bent = skin(rest, weights, field.pose, &field.rate), still = skin(rest, weights, field.pose);
  constexpr double dt = 1e-4;
  double without = 0;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Vec3 p = rest.positions[i], v = row(rest.attributes[0], i);
    const Vec3 expected = (field.bent(p + dt * v, dt) - field.bent(p - dt * v, -dt)) / (2 * dt);
    EXPECT_LT((row(bent.attributes[0], i) - expected).norm(), 1e-5 * (1 + expected.norm()));
    without = std::max(without, (row(still.attributes[0], i) - expected).norm() / expected.norm());
  }
  EXPECT_GT(without, 0.1) << "the check must see that the change of the map is missing";
}

TEST(SkinSplat, AVelocityFeelsAMapThatIsTheIdentityNow) {
  Shape rest;
  rest.positions = {Vec3(1, 2, 3)};
  add_attribute(rest, "v", Kind::Velocity, Type::Float32, 3);
  SkinWeights weights;
  weights.offsets = {0, 1};
  weights.maps = {0};
  weights.weights = {1};
  Affine rate;
  rate << 2 * Mat3::Identity(), Vec3(0, 0, 5);
  const Pose rates = {rate};
  const Shape out = skin(rest, weights, {identity_map()}, &rates);
  EXPECT_EQ(row(out.attributes[0], 0), Vec3(2, 4, 11));
  EXPECT_EQ(out.positions, rest.positions);
}

TEST(SkinSplat, IdentityAndTranslationKeepEveryBit) {
  Field field;
  Shape rest = field.shape(200);
  add_splats(rest, 0.01, 3);
  Attribute& velocity = add_attribute(rest, "v", Kind::Velocity, Type::Float32, 3);
  velocity.set_number(0, 0, -0.0);
  const SkinWeights weights = field.bind(rest.positions);
  EXPECT_TRUE(skin(rest, weights, Pose(3, identity_map())).attributes == rest.attributes);
  fill(velocity, field.random);
  // Weights are floats, and their gradients do not quite sum to zero: a far move must not show in the derivative.
  Affine far = identity_map();
  far.col(3) = Vec3(1e6, 2e6, -3e6);
  EXPECT_TRUE(skin(rest, weights, Pose(3, far)).attributes == rest.attributes);
}

TEST(SkinSplat, TheSameBitsForAnyNumberOfThreads) {
  Field field;
  Shape rest = field.shape(5000);
  add_splats(rest, 0.01, 3);
  const SkinWeights weights = field.bind(rest.positions);
  set_thread_count(1);
  const Shape one = skin(rest, weights, field.pose);
  set_thread_count(3);
  const Shape three = skin(rest, weights, field.pose);
  set_thread_count(2);
  EXPECT_TRUE(one.attributes == three.attributes);
}

TEST(SkinSplat, OddSplatsAreLeftAlone) {
  Field field;
  Shape rest = field.shape(4);
  add_splats(rest, 0.01, 1);
  rest.positions[1] = Vec3(std::nan(""), 0, 0);
  for (int c = 0; c < 4; ++c) rest.find("rot")->set_number(2, c, 0);
  rest.find("f_rest")->set_number(3, 0, std::numeric_limits<double>::infinity());
  const Shape bent = skin(rest, field.bind(rest.positions), field.pose);
  for (const std::size_t i : {1u, 2u})
    for (const char* name : {"rot", "scale"}) {
      const Attribute &before = *rest.find(name), &after = *bent.find(name);
      const std::size_t size = before.row_size();
      EXPECT_EQ(std::memcmp(&before.values[i * size], &after.values[i * size], size), 0) << name << i;
    }
  EXPECT_NE(bent.find("rot")->number(3, 0), rest.find("rot")->number(3, 0));
}

TEST(SkinSplat, TellsWhatNeedsGradientsAndWhatIsNotBent) {
  Shape shape;
  shape.positions.assign(2, Vec3::Zero());
  EXPECT_FALSE(needs_gradients(shape));
  add_attribute(shape, "n", Kind::Normal, Type::Float32, 3);
  add_attribute(shape, "f_dc", Kind::SphericalHarmonics, Type::Float32, 3);
  add_attribute(shape, "rot", Kind::Quaternion, Type::Float32, 4);
  EXPECT_FALSE(needs_gradients(shape));
  EXPECT_EQ(not_bent(shape), std::vector<std::string>{
                                 "\"rot\" stays as it is: expected a quaternion of 4 and log-scales of 3 floats for "
                                 "each point, found 4 of float32"});
  add_attribute(shape, "scale", Kind::LogScale, Type::Float32, 3);
  EXPECT_TRUE(needs_gradients(shape));
  EXPECT_TRUE(not_bent(shape).empty());
  add_attribute(shape, "f_rest", Kind::SphericalHarmonics, Type::Float32, 12);
  ASSERT_EQ(not_bent(shape).size(), 1u);
  EXPECT_EQ(not_bent(shape)[0],
            "\"f_rest\" stays as it is: expected 9, 24 or 45 floats, spherical harmonics of bands 1 to 3 in three "
            "channels, found 12 of float32");
  for (const Kind kind : {Kind::Vector, Kind::Velocity}) {
    Shape other;
    add_attribute(other, "v", kind, Type::Float32, 3);
    EXPECT_TRUE(needs_gradients(other));
  }
}

}  // namespace sinew
