#include "deformers/shell_energy.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <numbers>

#include "apps/samples/meshes.h"
#include "engine/geometry/random.h"

namespace sinew {
namespace {

using std::numbers::pi;

double number(std::uint64_t seed, std::uint64_t i) {
  return 2 * random_unit(seed, i) - 1;
}

Vec3 vector(std::uint64_t seed, std::uint64_t i) {
  return {number(seed, 3 * i), number(seed, 3 * i + 1), number(seed, 3 * i + 2)};
}

std::vector<Vec3> shaken(std::vector<Vec3> x, double by, std::uint64_t seed) {
  for (std::size_t v = 0; v < x.size(); ++v) x[v] += by * vector(seed, v);
  return x;
}

/// A closed cylinder, and two other poses of it.
struct Poses {
  ShellMesh mesh;
  std::vector<std::vector<Vec3>> poses;

  Poses() : mesh(shell_mesh_of(samples::cylinder(8, 1, 5), {})) {
    std::vector<Vec3> rest = mesh.rest();
    poses = {rest, shaken(rest, 0.004, 5), shaken(rest, 0.006, 6)};
  }
  ShellEnergy energy(ShellStiffness stiffness = {}) const { return {poses, mesh.triangles, stiffness}; }
};

/// All vertices but every fifth are unknowns.
std::vector<Index> some_unknowns(std::size_t vertices, Index& count) {
  std::vector<Index> number(vertices, ShellEdge::none);
  count = 0;
  for (std::size_t v = 0; v < vertices; ++v)
    if (v % 5 != 0) number[v] = count++;
  return number;
}

/// Two ties, one in the plane of its triangle.
void add_ties(ShellEnergy& energy, const Poses& p) {
  energy.set_ties({{p.mesh.triangles[3], Vec3(0.2, 0.5, 0.3), 0.04}, {p.mesh.triangles[17], Vec3(0.6, -0.1, 0.5), 0}});
  energy.set_targets({Vec3(0.1, 0, 0.2), Vec3(0, 0.2, 0)});
}

TEST(ShellEnergy, TheDihedralAngleAndItsGradient) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(0.5, 1, 0);
  for (const double fold : {-2.8, -1.0, 0.0, 0.4, 3.0}) {
    const Vec3 d(0.4, -std::cos(fold), std::sin(fold));
    EXPECT_NEAR(std::abs(dihedral_angle(a, b, c, d)), std::abs(fold), 1e-12);
  }
  std::array<Vec3, 4> x;
  for (std::uint64_t round = 0; round < 50; ++round) {
    for (std::size_t k = 0; k < 4; ++k) x[k] = vector(round, k);
    const Hinge hinge = hinge_at(x[0], x[1], x[2], x[3]);
    EXPECT_EQ(hinge.theta, dihedral_angle(x[0], x[1], x[2], x[3]));
    for (std::size_t k = 0; k < 4; ++k)
      for (int c = 0; c < 3; ++c) {
        const double h = 1e-6;
        std::array<Vec3, 4> more = x, less = x;
        more[k][c] += h;
        less[k][c] -= h;
        const double slope = std::remainder(dihedral_angle(more[0], more[1], more[2], more[3]) -
                                                dihedral_angle(less[0], less[1], less[2], less[3]),
                                            2 * pi) /
                             (2 * h);
        EXPECT_NEAR(hinge.gradient[k][c], slope, 1e-5 * (1 + std::abs(slope))) << round;
      }
  }
}

TEST(ShellEnergy, ATriangleWithoutAreaHasADefinedAngle) {
  const Hinge hinge = hinge_at(Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0.5, 0, 0), Vec3(0, 1, 0));
  EXPECT_TRUE(std::isfinite(hinge.theta));
  for (const Vec3& g : hinge.gradient) EXPECT_TRUE(g.allFinite());
  const Hinge point = hinge_at(Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0), Vec3(0, 0, 0));
  for (const Vec3& g : point.gradient) EXPECT_EQ(g, Vec3(0, 0, 0));
}

TEST(ShellEnergy, TheVolumeOfABoxAndItsPlace) {
  const Shape box = samples::box({2, 3, 4}, Vec3(0.5, 0.5, 0.5));
  const ShellMesh mesh = shell_mesh_of(box, {});
  EXPECT_NEAR(std::abs(volume_of(mesh.rest(), mesh.triangles)), 1 * 1.5 * 2, 1e-12);
}

TEST(ShellEnergy, AtRestThereIsNone) {
  const Poses p;
  ShellEnergy energy = p.energy();
  Index count = 0;
  energy.set_unknowns(some_unknowns(p.mesh.size(), count), count, {});
  EXPECT_NEAR(energy.energy(p.poses[0]).total(), 0, 1e-20);
  energy.set_weights(std::vector<double>{0, 1});
  EXPECT_NEAR(energy.energy(p.poses[2]).total(), 0, 1e-20) << "a pose is the rest of its own weight";
  EXPECT_GT(energy.energy(p.poses[1]).total(), 0.1);
}

TEST(ShellEnergy, GradientsMatchCentralDifferences) {
  const Poses p;
  for (const bool learned : {false, true}) {
    ShellEnergy energy = p.energy({100, 1, 1000, learned});
    Index count = 0;
    const std::vector<Index> number = some_unknowns(p.mesh.size(), count);
    const std::vector<double> factors = [&] {
      std::vector<double> f(p.mesh.size(), 1);
      f[7] = 10;
      return f;
    }();
    energy.set_unknowns(number, count, factors);
    add_ties(energy, p);
    const std::vector<double> alpha = {0.3, -0.4};
    energy.set_weights(alpha);
    ASSERT_TRUE(energy.keeps_volume());
    const std::vector<Vec3> x = shaken(p.poses[0], 0.01, 9);
    ASSERT_EQ(energy.collapsed(x), 0U);
    std::vector<double> g(3 * count), by_alpha(2);
    energy.gradient(x, g, by_alpha);
    const double h = 1e-6;
    double largest = 0;
    for (const double d : g) largest = std::max(largest, std::abs(d));
    for (std::size_t v = 0; v < x.size(); ++v)
      for (int c = 0; c < 3 && number[v] != ShellEdge::none; ++c) {
        std::vector<Vec3> more = x, less = x;
        more[v][c] += h;
        less[v][c] -= h;
        const double slope = (energy.energy(more).total() - energy.energy(less).total()) / (2 * h);
        ASSERT_NEAR(g[3 * number[v] + static_cast<std::size_t>(c)], slope, 1e-6 * largest) << v;
      }
    for (std::size_t k = 0; k < 2; ++k) {
      std::vector<double> more = alpha, less = alpha;
      more[k] += h;
      less[k] -= h;
      energy.set_weights(more);
      const double up = energy.energy(x).total();
      energy.set_weights(less);
      EXPECT_NEAR(by_alpha[k], (up - energy.energy(x).total()) / (2 * h), 1e-5 * std::abs(by_alpha[k]));
    }
  }
}

/// J by differences of the residuals would need these apart; J'J is the second derivative of E where all residuals are
/// zero, so that is where it is measured.
TEST(ShellEnergy, TheNormalMatrixIsTheSecondDerivativeWhereTheResidualsAreZero) {
  const Poses p;
  ShellEnergy energy = p.energy();
  Index count = 0;
  const std::vector<Index> number = some_unknowns(p.mesh.size(), count);
  energy.set_unknowns(number, count, {});
  const ShellTie tie{p.mesh.triangles[3], Vec3(0.2, 0.5, 0.3), 0.04};
  const std::vector<double> alpha = {0, 1};
  energy.set_ties({tie});
  energy.set_targets({tie.at(p.poses[2])});
  energy.set_weights(alpha);
  BlockMatrix A = energy.pattern();
  ShellEnergy::Normal normal;
  energy.hessian(p.poses[2], A, normal);

  const Eigen::Index n = 3 * static_cast<Eigen::Index>(count);
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n + 2, n + 2);
  for (Index j = 0; j < A.size(); ++j)
    for (std::size_t e = A.offsets[j]; e < A.offsets[j + 1]; ++e) {
      const Eigen::Map<const Mat3> block(A.at(e));
      H.block<3, 3>(3 * A.rows[e], 3 * j) = block;
      H.block<3, 3>(3 * j, 3 * A.rows[e]) = block.transpose();
    }
  const Eigen::Map<const Eigen::MatrixXd> B(normal.B.data(), n, 2), C(normal.C.data(), 2, 2);
  const Eigen::Map<const Eigen::VectorXd> u(normal.u.data(), n + 2);
  H.topRightCorner(n, 2) = B;
  H.bottomLeftCorner(2, n) = B.transpose();
  H.bottomRightCorner(2, 2) = C;
  H += u * u.transpose();

  // The response to a displacement of all vertices, held ones too: of the free ones alone it is this matrix times it.
  std::vector<Vec3> d(p.mesh.size(), Vec3::Zero());
  Eigen::VectorXd free = Eigen::VectorXd::Zero(n + 2);
  for (std::size_t v = 0; v < d.size(); ++v) {
    if (number[v] == ShellEdge::none) continue;
    d[v] = vector(11, v);
    free.segment<3>(3 * number[v]) = d[v];
  }
  std::vector<double> response = energy.response(p.poses[2], d);
  EXPECT_LT((Eigen::Map<Eigen::VectorXd>(response.data(), n + 2) - H * free).norm(), 1e-9 * (H * free).norm());

  const double h = 1e-6;
  const auto gradient_at = [&](Eigen::Index i, double by) {
    std::vector<Vec3> x = p.poses[2];
    std::vector<double> a = alpha;
    if (i < n) {
      for (std::size_t v = 0; v < x.size(); ++v)
        if (number[v] == static_cast<Index>(i / 3)) x[v][i % 3] += by;
    } else {
      a[static_cast<std::size_t>(i - n)] += by;
    }
    energy.set_weights(a);
    std::vector<double> g(static_cast<std::size_t>(n)), by_alpha(2);
    energy.gradient(x, g, by_alpha);
    g.insert(g.end(), by_alpha.begin(), by_alpha.end());
    return Eigen::VectorXd(Eigen::Map<Eigen::VectorXd>(g.data(), n + 2));
  };
  for (Eigen::Index i = 0; i < n + 2; ++i) {
    const Eigen::VectorXd column = (gradient_at(i, h) - gradient_at(i, -h)) / (2 * h);
    ASSERT_LT((H.col(i) - column).norm(), 1e-5 * H.cwiseAbs().maxCoeff()) << i;
  }
}

TEST(ShellEnergy, WeightsOfAPoseAreFound) {
  const Poses p;
  ShellEnergy energy = p.energy();
  Index count = 0;
  energy.set_unknowns(some_unknowns(p.mesh.size(), count), count, {});
  energy.set_weights(std::vector<double>{0.5, 0.5});
  const std::vector<double> found = energy.best_weights(p.poses[1], {});
  EXPECT_NEAR(found[0], 1, 1e-6);
  EXPECT_NEAR(found[1], 0, 1e-6);
  const std::vector<std::optional<double>> pinned = {std::nullopt, 0.25};
  EXPECT_EQ(energy.best_weights(p.poses[1], pinned)[1], 0.25);
}

TEST(ShellEnergy, AnEdgeThatAnExampleFoldsTheOtherWayHasNoAngle) {
  // A hinge that stands at +170 degrees at rest and at -170 in the example.
  const auto folded = [](double degrees) {
    const double t = degrees * pi / 180;
    return std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {0.5, 1, 0}, {0.5, -std::cos(t), std::sin(t)}};
  };
  const std::vector<Triangle> triangles = {{0, 1, 2}, {1, 0, 3}};
  const std::vector<std::vector<Vec3>> far = {folded(170), folded(-170)}, near = {folded(80), folded(-80)};
  EXPECT_EQ(ShellEnergy(far, triangles, {}).folds(), 1U);
  EXPECT_EQ(ShellEnergy(near, triangles, {}).folds(), 0U);
}

TEST(ShellEnergy, LearnedStiffnessIsLeastWhereExamplesChangeMost) {
  const Poses p;
  std::vector<std::vector<Vec3>> poses = {p.poses[0], p.poses[0]};
  poses[1][20] += Vec3(0.05, 0, 0);
  ShellEnergy even(poses, p.mesh.triangles, {100, 1, 0, false}), learned(poses, p.mesh.triangles, {100, 1, 0, true});
  Index count = 0;
  const std::vector<Index> number = some_unknowns(p.mesh.size(), count);
  even.set_unknowns(number, count, {});
  learned.set_unknowns(number, count, {});
  const auto ratio = [&](std::size_t v) {
    std::vector<Vec3> x = p.poses[0];
    x[v] += Vec3(0.01, 0.01, 0.01);
    return learned.energy(x).total() / even.energy(x).total();
  };
  EXPECT_NEAR(ratio(0), 1, 0.05) << "far from what moved";
  EXPECT_LT(ratio(20), 0.7);
}

TEST(ShellEnergy, OpenOrTwistedSurfacesHaveNoVolume) {
  const Shape plane = samples::bumpy_plane();
  const ShellMesh mesh = shell_mesh_of(plane, {});
  EXPECT_FALSE(ShellEnergy(mesh.poses, mesh.triangles, {}).keeps_volume());
  const Poses p;
  std::vector<Triangle> turned = p.mesh.triangles;
  std::swap(turned[5][0], turned[5][1]);
  EXPECT_FALSE(ShellEnergy(p.poses, turned, {}).keeps_volume());
  EXPECT_TRUE(p.energy().keeps_volume());
}

}  // namespace
}  // namespace sinew
