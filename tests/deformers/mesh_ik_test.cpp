#include "tests/benchmarks/mesh_ik.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/samples/meshes.h"
#include "engine/geometry/bounds.h"
#include "engine/geometry/nearest.h"
#include "engine/geometry/topology.h"
#include "engine/io/io.h"
#include "tests/shared_data.h"

namespace sinew::benchmarks {
namespace {

using Poses = std::vector<std::vector<Vec3>>;

std::vector<MeshIk::Triangle> triangles_of_shape(const Shape& shape) {
  const std::vector<Index> corners = triangles_of(shape.faces);
  std::vector<MeshIk::Triangle> out;
  for (std::size_t c = 0; c < corners.size(); c += 3) out.push_back({corners[c], corners[c + 1], corners[c + 2]});
  return out;
}

/// The bar bent about z by so many degrees along its length, and by so much thicker at its end.
std::vector<Vec3> bent(const Shape& bar, double degrees, double thicker) {
  constexpr double length = 1.6;
  std::vector<Vec3> out;
  for (const Vec3& p : bar.positions) {
    const double u = p.y() / length, angle = degrees * M_PI / 180 * u, radius = length / (degrees * M_PI / 180);
    const Vec3 across = (1 + thicker * u) * Vec3(p.x(), 0, p.z());
    out.push_back(Vec3(radius * (1 - std::cos(angle)), radius * std::sin(angle), 0) +
                  Eigen::AngleAxisd(-angle, Vec3::UnitZ()) * across);
  }
  return out;
}

double farthest(std::span<const Vec3> a, std::span<const Vec3> b) {
  double out = 0;
  for (std::size_t i = 0; i < a.size(); ++i) out = std::max(out, (a[i] - b[i]).norm());
  return out;
}

/// A closed bar of 4 x 16 x 4 cells, straight, bent to one side and to the other, thick and turned away.
class MeshIkTest : public testing::Test {
 protected:
  MeshIkTest() : bar_(samples::box({4, 16, 4}, Vec3(0.1, 0.1, 0.1))) {
    poses_ = {bar_.positions, bent(bar_, 100, 0), bent(bar_, -60, 0.5)};
    for (Vec3& p : poses_[2]) p = Eigen::AngleAxisd(0.7, Vec3(1, 2, 3).normalized()) * p + Vec3(0.5, 0, -1);
    for (Index v = 0; v < bar_.size(); ++v)
      if (bar_.positions[v].y() < 0.01 || bar_.positions[v].y() > 1.59) held_.push_back(v);
  }
  MeshIk made() const { return {bar_.positions, triangles_of_shape(bar_), poses_, held_}; }
  std::vector<Vec3> held_of(std::span<const Vec3> x) const {
    std::vector<Vec3> out;
    for (const Index v : held_) out.push_back(x[v]);
    return out;
  }

  Shape bar_;
  Poses poses_;
  std::vector<Index> held_;
};

TEST_F(MeshIkTest, TheWeightsOfAnExampleGiveThatExample) {
  const MeshIk ik = made();
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    std::vector<double> weights(poses_.size(), 0.0);
    weights[i] = 1;
    EXPECT_LT(farthest(ik.blend(weights), poses_[i]), 1e-9) << i;
  }
}

TEST_F(MeshIkTest, HandlesOfAnExampleFindItsWeights) {
  const MeshIk ik = made();
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    const MeshIk::Answer answer = ik.solve(held_of(poses_[i]));
    EXPECT_TRUE(answer.converged);
    EXPECT_LT(answer.iterations, 30);
    EXPECT_LT(farthest(answer.positions, poses_[i]), 1e-7) << i;
    for (std::size_t k = 0; k < poses_.size(); ++k) EXPECT_NEAR(answer.weights[k], k == i ? 1 : 0, 1e-7) << i;
  }
}

TEST_F(MeshIkTest, TheFeatureMapHasItsDerivative) {
  const MeshIk ik = made();
  for (const std::vector<double>& weights : {std::vector<double>{0.3, 0.5, 0.2}, {0, 0, 0}, {-0.4, 1.3, 0.7}})
    for (std::size_t k = 0; k < weights.size(); ++k) {
      constexpr double h = 1e-5;
      std::vector<double> more = weights, less = weights;
      more[k] += h;
      less[k] -= h;
      const std::vector<Vec3> plus = ik.features(more), minus = ik.features(less), J = ik.derivative(weights, k);
      double error = 0, size = 0;
      for (std::size_t i = 0; i < J.size(); ++i) {
        error = std::max(error, ((plus[i] - minus[i]) / (2 * h) - J[i]).norm());
        size = std::max(size, J[i].norm());
      }
      EXPECT_GT(size, 0.1);
      EXPECT_LT(error, 1e-8) << k;
    }
}

TEST_F(MeshIkTest, HandlesAreHeldAndNoOtherWeightsAreBetter) {
  const MeshIk ik = made();
  std::vector<Vec3> targets = held_of(poses_[1]);
  for (std::size_t i = 0; i < held_.size(); ++i)
    if (bar_.positions[held_[i]].y() > 1) targets[i] += Vec3(-0.2, 0.3, 0.1);
  const MeshIk::Answer answer = ik.solve(targets);
  EXPECT_TRUE(answer.converged);
  for (std::size_t i = 0; i < held_.size(); ++i) EXPECT_EQ(answer.positions[held_[i]], targets[i]);
  EXPECT_GT(answer.energy, 1e-4);
  // The energy as it is told, and its derivative by each weight: the vertices are at their best, so J'r is all of it.
  const std::vector<Vec3> f = ik.features(answer.weights);
  const std::vector<MeshIk::Triangle> triangles = triangles_of_shape(bar_);
  std::vector<Vec3> r(f.size());
  double energy = 0;
  for (std::size_t j = 0; j < triangles.size(); ++j) {
    const auto edges = [&](std::span<const Vec3> x) {
      Eigen::Matrix<double, 3, 2> out;
      out << x[triangles[j][1]] - x[triangles[j][0]], x[triangles[j][2]] - x[triangles[j][0]];
      return out;
    };
    const Eigen::Matrix<double, 3, 2> rest = edges(bar_.positions);
    Eigen::Matrix<double, 3, 2> B;
    B.col(0) = rest.col(0).normalized();
    B.col(1) = rest.col(0).cross(rest.col(1)).cross(rest.col(0)).normalized();
    const Eigen::Matrix<double, 3, 2> now = edges(answer.positions) * (B.transpose() * rest).inverse();
    for (std::size_t k = 0; k < 2; ++k) {
      r[2 * j + k] = f[2 * j + k] - now.col(static_cast<int>(k));
      energy += r[2 * j + k].squaredNorm();
    }
  }
  EXPECT_NEAR(energy, answer.energy, 1e-9 * energy);
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    const std::vector<Vec3> J = ik.derivative(answer.weights, k);
    double slope = 0, size = 0;
    for (std::size_t i = 0; i < J.size(); ++i) {
      slope += J[i].dot(r[i]);
      size += J[i].norm() * r[i].norm();
    }
    EXPECT_LT(std::abs(slope), 1e-6 * size) << k;
  }
}

TEST_F(MeshIkTest, APartWithoutAHandleGoesWhereTheExamplesHaveIt) {
  Shape two = bar_;
  const auto n = static_cast<Index>(bar_.size());
  for (const Vec3& p : bar_.positions) two.positions.push_back(p + Vec3(3, 0, 0));
  for (std::size_t f = 0; f < bar_.faces.size(); ++f) {
    std::vector<Index> corners(bar_.faces[f].begin(), bar_.faces[f].end());
    for (Index& corner : corners) corner += n;
    two.faces.add(corners);
  }
  Poses poses = poses_;
  for (std::vector<Vec3>& pose : poses) {
    const std::vector<Vec3> own = pose;
    for (const Vec3& p : own) pose.push_back(p + Vec3(3, 0, 0));
  }
  const MeshIk ik(two.positions, triangles_of_shape(two), poses, held_);
  const MeshIk::Answer answer = ik.solve(held_of(poses[2]));
  EXPECT_LT(farthest(answer.positions, poses[2]), 1e-6);
}

/// Twelve patches of twenty vertices as handles, toward a pose that is no example.
class RealPoses : public testing::TestWithParam<const char*> {};

TEST_P(RealPoses, FollowTwelvePatchesTowardAPoseThatIsNoExample) {
  SHARED_DATA(data, std::string("poses/") + GetParam());
  const bool horse = std::string(GetParam()) == "sumner_horse";
  std::vector<std::shared_ptr<const Shape>> shapes;
  for (const char* name : horse ? std::vector{"1.obj", "3.obj", "8.obj", "10.obj", "5.obj"}
                                : std::vector{"1.obj", "3.obj", "7.obj", "9.obj", "5.obj"})
    shapes.push_back(io::read((data / name).string()));
  const auto in_file = [](const Shape& shape) {
    std::vector<Vec3> out = shape.positions;
    for (Vec3& p : out) p += shape.origin;
    return out;
  };
  Poses poses;
  for (std::size_t i = 0; i + 1 < shapes.size(); ++i) poses.push_back(in_file(*shapes[i]));
  const std::vector<Vec3> wanted = in_file(*shapes.back());
  const std::vector<Vec3>& rest = poses[0];
  ASSERT_EQ(wanted.size(), rest.size());

  // Centres far from each other, and the twenty nearest vertices of each.
  std::vector<Index> held;
  std::vector<double> distance(rest.size(), HUGE_VAL);
  const NearestTree tree(rest);
  std::size_t centre = 0;
  for (int patch = 0; patch < 12; ++patch) {
    std::array<std::uint32_t, 20> near{};
    std::array<double, 20> unused{};
    tree.nearest(std::span(&rest[centre], 1), 20, near, unused);
    for (const std::uint32_t v : near)
      if (std::find(held.begin(), held.end(), v) == held.end()) held.push_back(v);
    for (std::size_t v = 0; v < rest.size(); ++v) distance[v] = std::min(distance[v], (rest[v] - rest[centre]).norm());
    centre = static_cast<std::size_t>(std::max_element(distance.begin(), distance.end()) - distance.begin());
  }
  std::vector<Vec3> targets;
  for (const Index v : held) targets.push_back(wanted[v]);

  const MeshIk ik(rest, triangles_of_shape(*shapes[0]), poses, held);
  const MeshIk::Answer answer = ik.solve(targets);
  const auto rms_to_wanted = [&](std::span<const Vec3> x) {
    double sum = 0;
    for (std::size_t v = 0; v < x.size(); ++v) sum += (x[v] - wanted[v]).squaredNorm();
    return std::sqrt(sum / static_cast<double>(x.size())) / bounds_of(wanted).diagonal();
  };
  const double rms = rms_to_wanted(answer.positions);
  double nearest = HUGE_VAL;
  for (const std::vector<Vec3>& pose : poses) nearest = std::min(nearest, rms_to_wanted(pose));
  std::printf("%s: %zu vertices, %d iterations, rms %.4f diagonals (nearest example %.4f), weights", GetParam(),
              rest.size(), answer.iterations, rms, nearest);
  for (const double w : answer.weights) std::printf(" %.3f", w);
  std::printf("\n");
  EXPECT_TRUE(answer.converged);
  // What it is known to reach, half of the way from the nearest example at least.
  EXPECT_LT(rms, horse ? 0.02 : 0.075);
  EXPECT_LT(rms, 0.5 * nearest);
}

INSTANTIATE_TEST_SUITE_P(Poses, RealPoses, testing::Values("sumner_horse", "sumner_lion"),
                         [](const auto& parameter) { return std::string(parameter.param); });

}  // namespace
}  // namespace sinew::benchmarks
