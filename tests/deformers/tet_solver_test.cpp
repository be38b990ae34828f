#include "deformers/tet_solver.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "engine/geometry/random.h"
#include "engine/geometry/rotation.h"
#include "tests/deformers/solids.h"

namespace sinew {
namespace {

using test::box;
using test::Solid;

constexpr double pi = std::numbers::pi;

/// A bar of 4 x 4 x 16 cells along z, with both ends held, the upper one turned about its axis and moved.
struct Bar {
  Solid solid = box(4, 4, 16, 1.0 / 17);
  TetConstraints constraints;
  std::vector<TetTarget> targets{{}};

  Bar() {
    constraints.handles.emplace_back();
    for (Index v = 0; v < solid.vertices.size(); ++v) {
      if (v < 25) constraints.fixed.push_back(v);
      if (v >= 16 * 25) constraints.handles[0].vertices.push_back(v);
    }
    bend(Vec3(0, 0, 0), Vec3(0, 0, 0));
  }
  void bend(const Vec3& turn, const Vec3& move) {
    const Vec3 centre(2.0 / 17, 2.0 / 17, 16.0 / 17);
    const double angle = turn.norm();
    const Mat3 R = angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Mat3::Identity();
    targets[0].positions.clear();
    for (const Index v : constraints.handles[0].vertices)
      targets[0].positions.push_back(centre + R * (solid.vertices[v] - centre) + move);
    targets[0].turn = turn;
  }
};

SolveOptions thoroughly(int iterations = 2000) {
  SolveOptions options;
  options.max_iterations = iterations;
  options.epsilon = 1e-10;
  return options;
}

double worst(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double out = 0;
  for (std::size_t v = 0; v < a.size(); ++v) out = std::max(out, (a[v] - b[v]).norm());
  return out;
}

double total(const SolveReport& report) {
  return report.energy[0].second;
}

/// The report's own loop: linear solve, rotations, and again.
double plain_loop(const Bar& bar, int iterations) {
  TetEnergy energy(bar.solid.vertices, bar.solid.tets);
  std::vector<Vec3> x = bar.solid.vertices, g(x.size());
  std::vector<Index> number(x.size(), 0), free;
  for (const Index v : bar.constraints.fixed) number[v] = TetEnergy::none;
  for (std::size_t i = 0; i < bar.targets[0].positions.size(); ++i) {
    const Index v = bar.constraints.handles[0].vertices[i];
    number[v] = TetEnergy::none;
    x[v] = bar.targets[0].positions[i];
  }
  for (Index v = 0; v < x.size(); ++v)
    if (number[v] != TetEnergy::none) {
      number[v] = static_cast<Index>(free.size());
      free.push_back(v);
    }
  SparseCholesky cholesky;
  const BlockMatrix L = energy.laplacian(number, static_cast<Index>(free.size()), TetEnergy::Ties::No);
  cholesky.analyse(L);
  EXPECT_TRUE(cholesky.factorize(L));
  double E = 0;
  for (int k = 0; k < iterations; ++k) {
    energy.evaluate(x, k == 0 ? TetEnergy::Rotations::Kept : TetEnergy::Rotations::Nearest, g);
    for (int c = 0; c < 3; ++c) {
      std::vector<double> p;
      for (const Index v : free) p.push_back(g[v][c]);
      cholesky.solve(p);
      for (std::size_t i = 0; i < free.size(); ++i) x[free[i]][c] -= p[i];
    }
    E = energy.evaluate(x, TetEnergy::Rotations::Nearest, g);
  }
  return E;
}

TEST(TetSolver, RigidMotionOfTheHandlesIsFoundExactly) {
  Bar bar;
  bar.constraints.fixed.clear();
  TetSolver solver(bar.solid.vertices, bar.solid.tets);
  solver.prepare(bar.constraints);
  const Mat3 R = Eigen::AngleAxisd(2.0, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  std::vector<Vec3> moved = bar.solid.vertices;
  for (Vec3& p : moved) p = R * p + Vec3(0.3, 1, -2);
  for (std::size_t i = 0; i < bar.targets[0].positions.size(); ++i)
    bar.targets[0].positions[i] = moved[bar.constraints.handles[0].vertices[i]];
  bar.targets[0].turn.reset();
  const SolveReport report = solver.solve(bar.targets, thoroughly(), {});
  EXPECT_EQ(report.status, Status::Converged);
  EXPECT_LT(worst(solver.x(), moved), 1e-8);
}

TEST(TetSolver, EndsWhereTheReportsLoopEnds) {
  Bar bar;
  bar.bend(Vec3(0, 1.2, 0), Vec3(0.2, 0, -0.15));
  TetSolver solver(bar.solid.vertices, bar.solid.tets);
  solver.prepare(bar.constraints);
  std::vector<double> energies;
  const SolveReport report = solver.solve(bar.targets, thoroughly(), [&] { return true; });
  EXPECT_EQ(report.status, Status::Converged) << report.message;
  const double limit = plain_loop(bar, 3000);
  EXPECT_NEAR(total(report), limit, 1e-7 * limit);
  EXPECT_LT(report.iterations, 150);
  EXPECT_GT(plain_loop(bar, report.iterations), total(report));
}

TEST(TetSolver, EnergyNeverRises) {
  Bar bar;
  bar.bend(Vec3(2, 1, 0), Vec3(0.5, 0.2, -0.6));
  TetSolver solver(bar.solid.vertices, bar.solid.tets);
  solver.set_interpolation(false);
  solver.prepare(bar.constraints);
  double last = 1e300;
  std::vector<Vec3> g(bar.solid.vertices.size());
  (void)solver.solve(bar.targets, thoroughly(), [&] {
    const double now = TetEnergy(solver.energy()).evaluate(solver.x(), TetEnergy::Rotations::Nearest, g);
    EXPECT_LE(now, last * (1 + 1e-12));
    last = now;
    return true;
  });
  EXPECT_LT(last, 1e300);
}

/// The turn of the bar's middle layer about z that its vertices show, from 0 to 2 pi.
double turn_at(const Bar& bar, const std::vector<Vec3>& x, Index layer) {
  const Index a = layer * 25, b = layer * 25 + 24;
  const Vec3 before = bar.solid.vertices[b] - bar.solid.vertices[a], after = x[b] - x[a];
  const double angle = std::atan2(after.y(), after.x()) - std::atan2(before.y(), before.x());
  return angle < 0 ? angle + 2 * pi : angle;
}

TEST(TetSolver, AWholeTurnIsSpreadOverTheBarAtOnce) {
  Bar bar;
  bar.bend(Vec3(0, 0, 2 * pi), Vec3(0, 0, 0));
  TetSolver solver(bar.solid.vertices, bar.solid.tets);
  solver.prepare(bar.constraints);
  (void)solver.solve(bar.targets, thoroughly(1), {});
  for (Index layer = 2; layer < 15; ++layer)
    EXPECT_NEAR(turn_at(bar, solver.x(), layer), 2 * pi * layer / 16.0, 0.15) << layer;
  // Without interpolation the targets, which are where they were at rest, tell nothing of the turn: the planted defect.
  TetSolver blind(bar.solid.vertices, bar.solid.tets);
  blind.set_interpolation(false);
  blind.prepare(bar.constraints);
  (void)blind.solve(bar.targets, thoroughly(), {});
  EXPECT_LT(worst(blind.x(), bar.solid.vertices), 1e-6);
}

TEST(TetSolver, TurnsAddUpWhileDragging) {
  Bar bar;
  TetSolver solver(bar.solid.vertices, bar.solid.tets);
  solver.prepare(bar.constraints);
  SolveOptions quick = thoroughly(3);
  quick.quality = SolveOptions::Quality::Interactive;
  for (int step = 1; step <= 48; ++step) {
    bar.bend(Vec3(0, 0, 1.75 * pi * step / 48), Vec3(0, 0, 0));
    (void)solver.solve(bar.targets, quick, {});
  }
  (void)solver.solve(bar.targets, thoroughly(), {});
  EXPECT_NEAR(turn_at(bar, solver.x(), 8), 0.875 * pi, 0.1);
  EXPECT_NEAR(turn_at(bar, solver.x(), 4), 0.4375 * pi, 0.1);
}

TEST(TetSolver, RecoversFromRandomDifferentialCoordinates) {
  Bar bar;
  // A few handles alone, at rest [section 3.3]: three vertices.
  bar.constraints = {};
  bar.constraints.fixed = {0, 24, 16 * 25 + 12};
  int recovered = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    TetSolver solver(bar.solid.vertices, bar.solid.tets);
    solver.prepare(bar.constraints);
    std::vector<Mat3> R(bar.solid.tets.size());
    for (std::size_t j = 0; j < R.size(); ++j) {
      Eigen::Vector4d q;
      for (int k = 0; k < 4; ++k) q[k] = 2 * random_unit(seed, 4 * j + static_cast<std::size_t>(k)) - 1;
      R[j] = Eigen::Quaterniond(q.normalized()).toRotationMatrix();
    }
    solver.set_rotations(R);
    const SolveReport report = solver.solve({}, thoroughly(5000), {});
    recovered += report.status == Status::Converged && worst(solver.x(), bar.solid.vertices) < 1e-6;
  }
  EXPECT_EQ(recovered, 100);
}

TEST(TetSolver, RigidGroupsTurnAsOneAndStiffPartsBendLess) {
  Bar bar;
  bar.bend(Vec3(0, 1.5, 0), Vec3(0.4, 0, -0.2));
  const auto spread = [&](const TetConstraints& constraints) {
    TetSolver solver(bar.solid.vertices, bar.solid.tets);
    solver.prepare(constraints);
    (void)solver.solve(bar.targets, thoroughly(), {});
    // How far the rotations of layers 5 to 10 differ.
    double out = 0;
    const Mat3 first = nearest_rotation(solver.energy().map(5 * 96, solver.x()));
    for (Index j = 5 * 96; j < 11 * 96; ++j)
      out = std::max(out, (nearest_rotation(solver.energy().map(j, solver.x())) - first).norm());
    return out;
  };
  TetConstraints rigid = bar.constraints, stiff = bar.constraints;
  rigid.groups.emplace_back();
  stiff.stiffness.assign(bar.solid.tets.size(), 1);
  for (Index j = 5 * 96; j < 11 * 96; ++j) {
    rigid.groups[0].push_back(j);
    stiff.stiffness[j] = 10;
  }
  const double plain = spread(bar.constraints);
  EXPECT_LT(spread(rigid), 0.35 * plain);
  EXPECT_LT(spread(stiff), 0.1 * plain);
}

TEST(TetSolver, TiesReachTheirTargets) {
  Bar bar;
  bar.constraints.handles[0] = {{}, {{{410, 411, 416, 386}, {0.25, 0.25, 0.25, 0.25}}}};
  Vec3 at = Vec3::Zero();
  for (const Index v : {410, 411, 416, 386}) at += 0.25 * bar.solid.vertices[v];
  bar.targets = {{{at + Vec3(0.15, 0, 0)}, std::nullopt}};
  TetSolver solver(bar.solid.vertices, bar.solid.tets);
  solver.prepare(bar.constraints);
  const SolveReport report = solver.solve(bar.targets, thoroughly(), {});
  EXPECT_EQ(report.status, Status::Converged);
  Vec3 now = Vec3::Zero();
  for (const Index v : {410, 411, 416, 386}) now += 0.25 * solver.x()[v];
  EXPECT_LT((now - bar.targets[0].positions[0]).norm(), 1e-4);
}

TEST(TetSolver, PartsWithoutHandlesRest) {
  Bar bar;
  const Index n = static_cast<Index>(bar.solid.vertices.size());
  const Solid other = box(2, 2, 2, 0.1);
  for (const Vec3& p : other.vertices) bar.solid.vertices.push_back(p + Vec3(1, 0, 0));
  for (Tet tet : other.tets) {
    for (Index& v : tet) v += n;
    bar.solid.tets.push_back(tet);
  }
  bar.bend(Vec3(0, 0, 1), Vec3(0, 0, 0));
  TetSolver solver(bar.solid.vertices, bar.solid.tets);
  solver.prepare(bar.constraints);
  EXPECT_EQ(solver.resting_parts(), 1u);
  EXPECT_EQ(solver.solve(bar.targets, thoroughly(), {}).status, Status::Converged);
  for (std::size_t v = n; v < solver.x().size(); ++v) EXPECT_EQ(solver.x()[v], bar.solid.vertices[v]);
}

TEST(TetSolver, SolvesThreeColumnsAsOneByOne) {
  const Solid solid = box(6, 5, 4, 0.1);
  const TetEnergy energy(solid.vertices, solid.tets);
  BlockMatrix L = energy.laplacian();
  for (Index j = 0; j < L.size(); ++j) L.values[L.offsets[j]] += 0.01;
  SparseCholesky cholesky;
  cholesky.analyse(L);
  ASSERT_TRUE(cholesky.factorize(L));
  const std::size_t n = solid.vertices.size();
  std::vector<double> three(3 * n);
  for (std::size_t i = 0; i < three.size(); ++i) three[i] = random_unit(11, i);
  std::vector<double> together = three;
  cholesky.solve_three(together);
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<double> one(n);
    for (std::size_t v = 0; v < n; ++v) one[v] = three[3 * v + c];
    cholesky.solve(one);
    for (std::size_t v = 0; v < n; ++v) EXPECT_NEAR(together[3 * v + c], one[v], 1e-12);
  }
}

}  // namespace
}  // namespace sinew
