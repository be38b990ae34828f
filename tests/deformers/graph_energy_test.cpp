#include "deformers/graph_energy.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <random>

#include "engine/geometry/rotation.h"
#include "tests/deformers/dense.h"

namespace sinew {

namespace {

/// A small random graph: 7 nodes of which 2 are fixed, 3 handles; a state far from rest.
struct Fixture {
  std::vector<Vec3> nodes;
  std::vector<std::pair<Index, Index>> edges;
  std::vector<bool> free = std::vector<bool>(7, true);
  std::vector<GraphHandle> handles;
  GraphEnergy energy;
  GraphState rigid = GraphState::rest(7), affine = GraphState::rest(7);
  std::mt19937 random{4};

  double value() { return std::uniform_real_distribution<double>(-1, 1)(random); }
  Vec3 vector() { return {value(), value(), value()}; }

  Fixture() {
    for (int j = 0; j < 7; ++j) nodes.push_back(vector());
    for (Index j = 0; j < 7; ++j)
      for (Index k = j + 1; k < 7; ++k)
        if (value() > -0.3) edges.emplace_back(j, k);
    free[2] = free[5] = false;
    std::vector<Vec3> targets;
    for (Index l = 0; l < 3; ++l) {
      handles.push_back({vector(), {l, l + 1, l + 3}, {0.5, 0.2, 0.3}});
      targets.push_back(vector());
    }
    energy.build(nodes, edges, free, handles, {1.3, 9, 70});
    energy.set_targets(targets);
    for (Index j = 0; j < 7; ++j)
      if (free[j]) {
        rigid.R[j] = affine.R[j] = rotation_of(2 * vector());
        rigid.t[j] = affine.t[j] = vector();
        affine.R[j] += 0.3 * (Mat3() << vector(), vector(), vector()).finished();
      }
  }
};

/// Frames that a solver would use: nearest rotations.
std::vector<Mat3> frames(const GraphState& x) {
  std::vector<Mat3> Q;
  for (const Mat3& R : x.R) Q.push_back(nearest_rotation(R));
  return Q;
}

/// The vector of weighted residuals f of eq. 10, written down from eq. 5, 7 and 8 with no regard to GraphEnergy.
Eigen::VectorXd plain_residuals(const Fixture& s, const GraphState& x, const std::vector<Vec3>& targets, bool rigid) {
  std::vector<double> f;
  const auto push = [&](const Vec3& r, double w) {
    for (int c = 0; c < 3; ++c) f.push_back(std::sqrt(w) * r[c]);
  };
  for (Index j = 0; j < 7; ++j)
    for (const auto& [a, b] : s.edges) {
      if (a != j && b != j) continue;
      const Index k = a == j ? b : a;
      push(x.R[j] * (s.nodes[k] - s.nodes[j]) + s.nodes[j] + x.t[j] - (s.nodes[k] + x.t[k]), 9);
    }
  for (std::size_t l = 0; l < 3; ++l) {
    Vec3 v = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      const Index j = s.handles[l].nodes[i];
      v += s.handles[l].weights[i] * (x.R[j] * (s.handles[l].v - s.nodes[j]) + s.nodes[j] + x.t[j]);
    }
    push(v - targets[l], 70);
  }
  if (!rigid)
    for (const Mat3& R : x.R) {
      const Mat3 C = R.transpose() * R;
      for (const double e : {C(0, 1), C(0, 2), C(1, 2), C(0, 0) - 1, C(1, 1) - 1, C(2, 2) - 1})
        f.push_back(std::sqrt(1.3) * e);
    }
  return Eigen::Map<Eigen::VectorXd>(f.data(), static_cast<Eigen::Index>(f.size()));
}

std::vector<Vec3> targets_of(Fixture& s) {
  std::vector<Vec3> targets;
  for (int l = 0; l < 3; ++l) targets.push_back(s.vector());
  s.energy.set_targets(targets);
  return targets;
}

}  // namespace

TEST(GraphEnergy, EqualsThePaperWrittenDownPlainly) {
  Fixture s;
  const std::vector<Vec3> targets = targets_of(s);
  EXPECT_NEAR(s.energy.energy(s.affine, false).total(), plain_residuals(s, s.affine, targets, false).squaredNorm(),
              1e-10);
  EXPECT_NEAR(s.energy.energy(s.rigid, true).total(), plain_residuals(s, s.rigid, targets, true).squaredNorm(), 1e-10);
}

TEST(GraphEnergy, DerivativesAgainstCentralDifferences) {
  Fixture s;
  const std::vector<Vec3> targets = targets_of(s);
  constexpr double h = 1e-6;
  for (const bool rigid : {true, false}) {
    const GraphState& x = rigid ? s.rigid : s.affine;
    const std::vector<Mat3> Q = frames(x);
    const int block = rigid ? 6 : 12;
    const Eigen::Index n = 5 * block;
    Eigen::MatrixXd J(plain_residuals(s, x, targets, rigid).size(), n);
    for (Eigen::Index i = 0; i < n; ++i) {
      std::vector<double> step(static_cast<std::size_t>(n), 0.0);
      step[static_cast<std::size_t>(i)] = 1;
      const auto at = [&](double scale) {
        const GraphState y = rigid ? s.energy.step_rigid(x, step, scale) : s.energy.step_affine(x, Q, step, scale);
        return plain_residuals(s, y, targets, rigid);
      };
      J.col(i) = (at(h) - at(-h)) / (2 * h);
    }
    std::vector<double> g(static_cast<std::size_t>(n));
    BlockMatrix H = s.energy.hessian_pattern(block);
    if (rigid) {
      s.energy.gradient_rigid(x, g);
      s.energy.hessian_rigid(x, H);
    } else {
      s.energy.gradient_affine(x, Q, g);
      s.energy.hessian_affine(x, Q, H);
    }
    const Eigen::VectorXd expected = J.transpose() * plain_residuals(s, x, targets, rigid);
    EXPECT_LT((Eigen::Map<Eigen::VectorXd>(g.data(), n) - expected).norm(), 1e-7 * expected.norm()) << block;
    const Eigen::MatrixXd JtJ = J.transpose() * J;
    EXPECT_LT((dense(H) - JtJ).norm(), 1e-7 * JtJ.norm()) << block;
  }
}

TEST(GraphEnergy, StepsKeepRotations) {
  Fixture s;
  std::vector<double> step(30);
  for (double& v : step) v = s.value();
  const GraphState y = s.energy.step_rigid(s.rigid, step, 0.7);
  for (const Mat3& R : y.R) {
    EXPECT_LT((R.transpose() * R - Mat3::Identity()).norm(), 1e-14);
    EXPECT_GT(R.determinant(), 0);
  }
}

TEST(GraphEnergy, NearestRotationIsNeverAMirror) {
  Fixture s;
  for (int i = 0; i < 50; ++i) {
    const Mat3 M = (Mat3() << s.vector(), s.vector(), s.vector()).finished();
    const Mat3 R = nearest_rotation(M);
    EXPECT_NEAR(R.determinant(), 1, 1e-12);
    EXPECT_LT((R.transpose() * R - Mat3::Identity()).norm(), 1e-12);
    if (M.determinant() > 0) {  // the stretch R' M is symmetric
      EXPECT_LT((R.transpose() * M - M.transpose() * R).norm(), 1e-9);
    }
  }
  EXPECT_NEAR(nearest_rotation(-Mat3::Identity()).determinant(), 1, 1e-12);
}

}  // namespace sinew
