/// Gaussian splats under a real deformation graph, against an evaluation that shares nothing with the program's: the
/// map p -> bent p is differentiated by central differences (bound at p +- h e), each covariance is compared with that
/// of this Jacobian, and each colour is looked at along the direction that turns with it.

#include <fmt/core.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "deformers/graph.h"
#include "engine/geometry/rotation.h"
#include "engine/geometry/skin.h"
#include "engine/io/io.h"
#include "tests/shared_data.h"
#include "tests/splats.h"

namespace sinew {

namespace {

/// A graph solved for the box's upper part turned about its lower one.
struct Bent {
  std::shared_ptr<Shape> rest;
  std::unique_ptr<Deformer> deformer;
  double step;  ///< of the differences

  Bent(std::shared_ptr<Shape> shape, const Vec3& low, const Vec3& high, int nodes, double angle)
      : rest(std::move(shape)), step(2e-4 * (high - low).norm()) {
    GraphOptions options;
    options.nodes = nodes;
    deformer = make_graph_deformer(rest, options);
    Constraints constraints;
    Handle handle;
    const Mat3 turn = Eigen::AngleAxisd(angle, Vec3(1, 0.3, 0.2).normalized()).toRotationMatrix();
    const Vec3 pivot = 0.5 * (low + high);
    for (Index i = 0; i < rest->size(); ++i) {
      const Vec3& p = rest->positions[i];
      const double height = (p.y() - low.y()) / (high.y() - low.y());
      if (height < 0.2) constraints.fixed.push_back(i);
      if (height <= 0.8) continue;
      handle.points.push_back(i);
      handle.targets.push_back(turn * (p - pivot) + pivot);
    }
    constraints.handles.push_back(handle);
    deformer->solve(constraints, {});
  }

  Shape skinned(Gradients gradients) const {
    return skin(*rest, deformer->bind(rest->positions, gradients), deformer->pose());
  }

  /// Of the map p -> bent p at each of the points; not a number where the map has a kink between the samples (other
  /// nodes become the nearest, and the derivative jumps): there the differences to both sides are not alike.
  std::vector<Mat3> jacobians() const {
    std::vector<Vec3> around;
    for (const Vec3& p : rest->positions)
      for (int c = 0; c < 3; ++c)
        for (const double h : {step, -step}) around.push_back(p + h * Vec3::Unit(c));
    std::vector<Vec3> moved(around.size()), middle(rest->size());
    skin_points(deformer->bind(around, Gradients::No), deformer->pose(), around, moved);
    skin_points(deformer->bind(rest->positions, Gradients::No), deformer->pose(), rest->positions, middle);
    std::vector<Mat3> J(rest->size());
    for (std::size_t i = 0; i < J.size(); ++i) {
      Mat3 forward, backward;
      for (int c = 0; c < 3; ++c) {
        const std::size_t k = 6 * i + 2 * static_cast<std::size_t>(c);
        forward.col(c) = (moved[k] - middle[i]) / step;
        backward.col(c) = (middle[i] - moved[k + 1]) / step;
      }
      J[i] = 0.5 * (forward + backward);
      if (!((forward - backward).norm() < 1e-2 * J[i].norm())) J[i].setConstant(std::nan(""));
    }
    return J;
  }
};

/// Ascending, relative.
struct Errors {
  std::vector<double> covariance, colour;
};

double quantile(const std::vector<double>& sorted, double part) {
  return sorted[static_cast<std::size_t>(part * static_cast<double>(sorted.size() - 1))];
}

Errors errors_of(const Shape& rest, const Shape& bent, const std::vector<Mat3>& J) {
  RandomSplats random(2);
  Errors errors;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const Vec3 d = random.direction();
    if (!J[i].allFinite()) continue;
    const Mat3 S = J[i] * covariance_at(rest, i) * J[i].transpose();
    errors.covariance.push_back((covariance_at(bent, i) - S).norm() / S.norm());
    const Vec3 before = colour_at(rest, i, d), after = colour_at(bent, i, nearest_rotation(J[i]) * d);
    errors.colour.push_back((after - before).norm() / std::max(before.norm(), 1e-2));
  }
  std::sort(errors.covariance.begin(), errors.covariance.end());
  std::sort(errors.colour.begin(), errors.colour.end());
  return errors;
}

void expect_right(const Bent& bent, const Shape& rest) {
  const std::vector<Mat3> J = bent.jacobians();
  const auto record = [](const char* what, const std::vector<double>& errors) {
    std::string line = std::string(what) + ", median, 90 %, 99 %, max:";
    for (const double part : {0.5, 0.9, 0.99, 1.0}) line += fmt::format(" {:.1e}", quantile(errors, part));
    std::puts(line.c_str());
  };
  const Errors right = errors_of(rest, bent.skinned(Gradients::Yes), J);
  std::printf("%zu of %zu splats away from kinks\n", right.covariance.size(), rest.size());
  ASSERT_GT(right.covariance.size(), rest.size() * 9 / 10);
  record("covariance", right.covariance);
  record("colour", right.colour);
  for (const std::vector<double>& errors : {right.covariance, right.colour}) {
    EXPECT_LT(quantile(errors, 0.5), 1e-4);
    EXPECT_LT(quantile(errors, 0.99), 1e-2);
    EXPECT_LT(quantile(errors, 0.999), 5e-2);
  }

  // Planted defects: the blended matrix M in place of the derivative, colours that are not turned.
  const Errors blended = errors_of(rest, bent.skinned(Gradients::No), J);
  record("covariance by M", blended.covariance);
  record("colour by M", blended.colour);
  EXPECT_GT(quantile(blended.covariance, 0.5), 1e-2);
  EXPECT_GT(quantile(blended.colour, 0.9), 1e-2);
  Shape unturned = bent.skinned(Gradients::Yes);
  *unturned.find("f_rest") = *rest.find("f_rest");
  EXPECT_GT(quantile(errors_of(rest, unturned, J).colour, 0.9), 0.1);
}

std::shared_ptr<Shape> column() {
  RandomSplats random(8);
  auto shape = std::make_shared<Shape>();
  for (int i = 0; i < 3000; ++i) shape->positions.emplace_back(random.vector().cwiseProduct(Vec3(0.2, 1, 0.2)));
  add_splats(*shape, 0.02, 3, Type::Float64);
  return shape;
}

}  // namespace

TEST(SplatBend, CovariancesAndColoursAreThoseOfTheMap) {
  const auto rest = column();
  expect_right(Bent(rest, Vec3(-0.2, -1, -0.2), Vec3(0.2, 1, 0.2), 60, 1.5), *rest);
}

TEST(SplatBend, ARealSplatFileToo) {
  SHARED_DATA(path, "splats/inria_format/point_cloud.ply");
  const auto rest = std::make_shared<Shape>(*io::read(path));
  Vec3 low, high;  // of the scene without the tenth on each side: single splats lie far out
  for (int c = 0; c < 3; ++c) {
    std::vector<double> x;
    for (const Vec3& p : rest->positions) x.push_back(p[c]);
    std::sort(x.begin(), x.end());
    low[c] = quantile(x, 0.1);
    high[c] = quantile(x, 0.9);
  }
  expect_right(Bent(rest, low, high, 200, 1.0), *rest);
}

/// A point that moves with its velocity while the graph's maps change: where it is bent to, a moment later and earlier.
TEST(SplatBend, VelocitiesAreDerivativesOfBentPositionsInTime) {
  const auto rest = column();
  rest->attributes.clear();
  Attribute& velocity = add_attribute(*rest, "velocity", Kind::Velocity, Type::Float64, 3);
  RandomSplats random(4);
  for (std::size_t i = 0; i < rest->size(); ++i)
    for (int c = 0; c < 3; ++c) velocity.set_number(i, c, random.value());
  const Bent now(rest, Vec3(-0.2, -1, -0.2), Vec3(0.2, 1, 0.2), 60, 1.0);
  const Bent later(rest, Vec3(-0.2, -1, -0.2), Vec3(0.2, 1, 0.2), 60, 1.1);
  const Pose &pose = now.deformer->pose(), &next = later.deformer->pose();
  Pose rate;  // the maps go on as from now to 0.1 s later
  for (std::size_t j = 0; j < pose.size(); ++j) rate.push_back((next[j] - pose[j]) / 0.1);
  const Shape bent = skin(*rest, now.deformer->bind(rest->positions, Gradients::Yes), pose, &rate);

  constexpr double dt = 2e-4;
  std::vector<Vec3> places[2];
  for (const double sign : {-1.0, 1.0}) {
    std::vector<Vec3> points = rest->positions;
    Pose then = pose;
    for (std::size_t i = 0; i < points.size(); ++i)
      for (int c = 0; c < 3; ++c) points[i][c] += sign * dt * velocity.number(i, c);
    for (std::size_t j = 0; j < then.size(); ++j) then[j] += sign * dt * rate[j];
    std::vector<Vec3>& moved = places[sign > 0];
    moved.resize(points.size());
    skin_points(now.deformer->bind(points, Gradients::No), then, points, moved);
  }
  std::vector<double> errors;
  for (std::size_t i = 0; i < rest->size(); ++i) {
    const Vec3 expected = (places[1][i] - places[0][i]) / (2 * dt);
    const Attribute& a = bent.attributes[0];
    const Vec3 found(a.number(i, 0), a.number(i, 1), a.number(i, 2));
    errors.push_back((found - expected).norm() / expected.norm());
  }
  std::sort(errors.begin(), errors.end());
  std::printf("velocity, median, 99 %%, max: %.1e %.1e %.1e\n", quantile(errors, 0.5), quantile(errors, 0.99),
              quantile(errors, 1));
  EXPECT_LT(quantile(errors, 0.5), 1e-4);
  EXPECT_LT(quantile(errors, 0.99), 1e-2);  // the rest lies at kinks of the weights
}

}  // namespace sinew
