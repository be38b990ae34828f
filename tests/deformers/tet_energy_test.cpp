#include "deformers/tet_energy.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "engine/geometry/parallel.h"
#include "engine/geometry/random.h"
#include "engine/geometry/rotation.h"
#include "tests/deformers/solids.h"

namespace sinew {
namespace {

using test::box;
using test::Solid;

double number(std::uint64_t seed, std::uint64_t i) {
  return 2 * random_unit(seed, i) - 1;
}

Vec3 vector(std::uint64_t seed, std::uint64_t i) {
  return {number(seed, 3 * i), number(seed, 3 * i + 1), number(seed, 3 * i + 2)};
}

Solid uneven_box() {
  Solid solid = box(3, 4, 2, 0.2);
  for (std::size_t v = 0; v < solid.vertices.size(); ++v) solid.vertices[v] += 0.03 * vector(1, v);
  return solid;
}

std::vector<Vec3> shaken(const Solid& solid, double by) {
  std::vector<Vec3> x = solid.vertices;
  for (std::size_t v = 0; v < x.size(); ++v) x[v] += by * vector(2, v);
  return x;
}

TEST(RotationLanes, IsTheNearestRotationOfAnyMatrix) {
  for (int round = 0; round < 2000; ++round) {
    Mat3Lanes M, R;
    std::array<Mat3, lane_count> matrices, before;
    for (std::size_t l = 0; l < lane_count; ++l) {
      const std::uint64_t i = static_cast<std::uint64_t>(round) * lane_count + l;
      for (int k = 0; k < 9; ++k) matrices[l].data()[k] = number(3, 9 * i + static_cast<std::uint64_t>(k));
      // Near a rotation, far from one, mirrored, tiny, huge.
      const Mat3 turn = Eigen::AngleAxisd(3 * number(4, i), vector(5, i).normalized()).toRotationMatrix();
      if (round % 4 == 1) matrices[l] = turn + 0.1 * matrices[l];
      if (round % 4 == 2) matrices[l] *= std::pow(10.0, 8 * number(6, i));
      if (round % 4 == 3) matrices[l].col(0) *= -1;
      before[l] = Eigen::AngleAxisd(3 * number(7, i), vector(8, i).normalized()).toRotationMatrix();
      for (std::size_t k = 0; k < 9; ++k) {
        M[k][l] = matrices[l].data()[k];
        R[k][l] = before[l].data()[k];
      }
    }
    nearest_rotations(M, R);
    for (std::size_t l = 0; l < lane_count; ++l) {
      Mat3 r;
      for (std::size_t k = 0; k < 9; ++k) r.data()[k] = R[k][l];
      ASSERT_NEAR(r.determinant(), 1, 1e-9);
      ASSERT_LT((r.transpose() * r - Mat3::Identity()).cwiseAbs().maxCoeff(), 1e-9);
      // tr(R'M) is what is maximised: compared by it, since nearly equal choices are equally right.
      const double best = (nearest_rotation(matrices[l]).transpose() * matrices[l]).trace();
      ASSERT_GE((r.transpose() * matrices[l]).trace(), best - 1e-9 * matrices[l].norm()) << matrices[l];
    }
  }
}

TEST(RotationLanes, KeepsTheRotationOfNothing) {
  Mat3Lanes M{}, R{};
  for (const std::size_t k : {0, 4, 8}) R[k] = Lanes{} + 1.0;
  nearest_rotations(M, R);
  for (std::size_t l = 0; l < lane_count; ++l) EXPECT_EQ(R[0][l], 1);
}

TEST(TetEnergy, LaplacianIsSymmetricWithConstantNullSpaceAndLinearPrecision) {
  const Solid solid = uneven_box();
  const TetEnergy energy(solid.vertices, solid.tets);
  const BlockMatrix L = energy.laplacian();  // the lower triangle alone is kept, so symmetry is by construction
  const std::size_t n = solid.vertices.size();
  std::vector<double> x(n), Lx(n);
  const auto largest = [&] {
    return std::abs(
        *std::max_element(Lx.begin(), Lx.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
  };
  std::fill(x.begin(), x.end(), 1.0);
  multiply(L, x, Lx);
  EXPECT_LT(largest(), 1e-13);
  // The divergence of a constant gradient is zero inside; on the boundary it is the flux through it.
  const Vec3 slope(0.3, -1.2, 0.7);
  for (std::size_t v = 0; v < n; ++v) x[v] = slope.dot(solid.vertices[v]);
  multiply(L, x, Lx);
  for (Index k = 1; k < 2; ++k)
    for (Index j = 1; j < 4; ++j)
      for (Index i = 1; i < 3; ++i) EXPECT_NEAR(Lx[(k * 5 + j) * 4 + i], 0, 1e-13);
  double sum = 0;
  for (const double v : Lx) sum += v;
  EXPECT_NEAR(sum, 0, 1e-12);
  // x' L x is the Dirichlet energy: here |slope|^2 times the volume.
  double dirichlet = 0;
  for (std::size_t v = 0; v < n; ++v) dirichlet += x[v] * Lx[v];
  EXPECT_NEAR(dirichlet, slope.squaredNorm() * test::volume_of(solid.vertices, solid.tets), 1e-12);
}

TEST(TetEnergy, DivergenceOfTheGradientIsTheLaplacian) {
  const Solid solid = uneven_box();
  TetEnergy energy(solid.vertices, solid.tets);
  const std::vector<Vec3> x = shaken(solid, 0.1);
  // With R = 0 the half gradient is G'D (G x) = L x.
  for (Index j = 0; j < solid.tets.size(); ++j) energy.set_rotation(j, Mat3::Zero());
  std::vector<Vec3> divergence(x.size());
  energy.evaluate(x, TetEnergy::Rotations::Kept, divergence);
  const BlockMatrix L = energy.laplacian();
  for (int c = 0; c < 3; ++c) {
    std::vector<double> u(x.size()), Lu(x.size());
    for (std::size_t v = 0; v < x.size(); ++v) u[v] = x[v][c];
    multiply(L, u, Lu);
    for (std::size_t v = 0; v < x.size(); ++v) EXPECT_NEAR(divergence[v][c], Lu[v], 1e-13);
  }
}

TEST(TetEnergy, GradientIsThatOfCentralDifferences) {
  const Solid solid = uneven_box();
  TetEnergy energy(solid.vertices, solid.tets);
  std::vector<double> stiffness(solid.tets.size());
  for (std::size_t j = 0; j < stiffness.size(); ++j) stiffness[j] = 1.5 + number(9, j);
  energy.set_stiffness(stiffness);
  energy.set_groups({{0, 1, 2, 20, 21}, {60, 61}});
  energy.set_ties({{{0, 1, 5, 9}, {0.4, 0.3, 0.2, 0.1}}});
  energy.set_targets({Vec3(0.1, 0.2, -0.1)});
  const std::vector<Vec3> x = shaken(solid, 0.05);
  std::vector<Vec3> g(x.size()), ignored(x.size());
  energy.evaluate(x, TetEnergy::Rotations::Nearest, g);
  const double h = 1e-6;
  double scale = 0;
  for (const Vec3& v : g) scale = std::max(scale, v.cwiseAbs().maxCoeff());
  for (std::size_t v = 0; v < x.size(); v += 3)
    for (int c = 0; c < 3; ++c) {
      std::vector<Vec3> a = x, b = x;
      a[v][c] -= h;
      b[v][c] += h;
      const double slope = (energy.evaluate(b, TetEnergy::Rotations::Nearest, ignored) -
                            energy.evaluate(a, TetEnergy::Rotations::Nearest, ignored)) /
                           (2 * h);
      EXPECT_NEAR(2 * g[v][c], slope, 1e-6 * scale) << v << " " << c;
    }
}

TEST(TetEnergy, RigidMotionCostsNothingAndMirroringDoes) {
  const Solid solid = uneven_box();
  TetEnergy energy(solid.vertices, solid.tets);
  const Mat3 R = Eigen::AngleAxisd(2.8, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  std::vector<Vec3> x = solid.vertices, g(x.size());
  for (Vec3& p : x) p = R * p + Vec3(3, -2, 5);
  EXPECT_LT(energy.evaluate(x, TetEnergy::Rotations::Nearest, g), 1e-20);
  for (Vec3& p : x) p.x() *= -1;
  const double volume = test::volume_of(solid.vertices, solid.tets);
  EXPECT_NEAR(energy.evaluate(x, TetEnergy::Rotations::Nearest, g), 4 * volume, 1e-9);
  for (Index j = 0; j < solid.tets.size(); ++j) EXPECT_GT(energy.rotation(j).determinant(), 0.999);
}

TEST(TetEnergy, MapsAllTetsAsOneByOne) {
  Solid solid = uneven_box();
  solid.tets.resize(solid.tets.size() - 3);  // the last lanes are empty
  const std::vector<Vec3> x = shaken(solid, 0.05);
  const TetEnergy energy(solid.vertices, solid.tets);
  std::vector<Mat3> T(solid.tets.size());
  energy.maps(x, T);
  for (Index j = 0; j < T.size(); ++j) EXPECT_LT((T[j] - energy.map(j, x)).norm(), 1e-12) << j;
}

TEST(TetEnergy, IsTheSameWithAnyNumberOfThreads) {
  const Solid solid = box(12, 12, 12, 0.05);
  const std::vector<Vec3> x = shaken(solid, 0.02);
  std::vector<Vec3> first;
  double E = 0;
  for (const int threads : {1, 2, 5}) {
    set_thread_count(threads);
    TetEnergy energy(solid.vertices, solid.tets);
    std::vector<Vec3> g(x.size());
    const double now = energy.evaluate(x, TetEnergy::Rotations::Nearest, g);
    if (first.empty()) {
      first = g;
      E = now;
    }
    EXPECT_EQ(now, E);
    EXPECT_TRUE(g == first);
  }
  set_thread_count(2);
}

}  // namespace
}  // namespace sinew
