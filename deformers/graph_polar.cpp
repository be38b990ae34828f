#include "deformers/graph_polar.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>

#include "engine/geometry/rotation.h"

namespace sinew {

namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;

/// Symmetric matrices by their six entries: xx, yy, zz, xy, xz, yz.
Mat3 symmetric(const Vec6& s) {
  Mat3 S;
  S << s[0], s[3], s[4], s[3], s[1], s[5], s[4], s[5], s[2];
  return S;
}

/// The derivative by those six, given that by all nine entries.
Vec6 by_symmetric(const Mat3& G) {
  Vec6 g;
  g << G(0, 0), G(1, 1), G(2, 2), G(0, 1) + G(1, 0), G(0, 2) + G(2, 0), G(1, 2) + G(2, 1);
  return g;
}

Mat3 half_off_diagonal(const Mat3& M) {
  Mat3 F = 0.5 * M;
  F.diagonal() = M.diagonal();
  return F;
}

struct Polar {
  std::vector<Mat3> Q, U;  ///< of each free node
  GraphState x;

  void set(std::size_t i, Index j) { x.R[j] = Q[i] * U[i]; }
};

Polar polar_of(const GraphEnergy& energy, const GraphState& x) {
  Polar out{{}, {}, x};
  for (const Index j : energy.free_nodes()) {
    out.Q.push_back(nearest_rotation(x.R[j]));
    const Mat3 U = out.Q.back().transpose() * x.R[j];
    out.U.push_back(0.5 * (U + U.transpose()));
    out.set(out.Q.size() - 1, j);
  }
  return out;
}

/// J'f: [omega, tau] of each free node, then S of each. With K = Q' sum r [beta, b]': omega from the skew part of K U',
/// tau from the last column, S from the symmetric part of K and from E_rot = sum_{a<=b} f_ab^2, f = U^2 - I, whose
/// derivative along S is 2 <F, S U + U S>, F with f_ab / 2 off the diagonal.
void gradient(const GraphEnergy& energy, const Polar& p, std::span<double> out) {
  const std::vector<GraphEnergy::Mat4> G = energy.linear_gradient(p.x);
  const std::size_t m = G.size();
  for (std::size_t i = 0; i < m; ++i) {
    const Eigen::Matrix<double, 3, 4> K = p.Q[i].transpose() * G[i].topRows<3>();
    const Mat3& U = p.U[i];
    const Mat3 W = K.leftCols<3>() * U;
    Eigen::Map<Vec6> rigid(out.data() + 6 * i), strain(out.data() + 6 * (m + i));
    rigid << W(2, 1) - W(1, 2), W(0, 2) - W(2, 0), W(1, 0) - W(0, 1), K.col(3);
    const Mat3 F = half_off_diagonal(U * U - Mat3::Identity());
    strain = by_symmetric(K.leftCols<3>() + energy.weights().rotation * (F * U + U * F));
  }
}

void step(const GraphEnergy& energy, const Polar& from, std::span<const double> s, double scale, Polar& to) {
  const std::size_t m = from.Q.size();
  to.Q.resize(m);
  to.U.resize(m);
  for (std::size_t i = 0; i < m; ++i) {
    const Index j = energy.free_nodes()[i];
    const Eigen::Map<const Vec3> omega(s.data() + 6 * i), tau(s.data() + 6 * i + 3);
    to.x.t[j] = from.x.t[j] + scale * (from.Q[i] * tau);
    to.Q[i] = from.Q[i] * rotation_of(scale * omega);
    to.U[i] = from.U[i] + scale * symmetric(Eigen::Map<const Vec6>(s.data() + 6 * (m + i)));
    to.set(i, j);
  }
}

using Mat6 = Eigen::Matrix<double, 6, 6>;

/// Second derivatives of the energy (halved) by the strain of each free node.
std::vector<Eigen::LLT<Mat6>> strain_curvature(const GraphEnergy& energy, const std::vector<Mat3>& Us) {
  std::vector<Eigen::LLT<Mat6>> out(Us.size());
  const double w = energy.weights().rotation;
  for (std::size_t i = 0; i < Us.size(); ++i) {
    const Mat3& U = Us[i];
    const Mat3 A = energy.A_of(i).topLeftCorner<3, 3>(), F = half_off_diagonal(U * U - Mat3::Identity());
    Mat6 first, second;
    for (int c = 0; c < 6; ++c) {
      const Mat3 S = symmetric(Vec6::Unit(c)), dF = half_off_diagonal(S * U + U * S);
      first.col(c) = by_symmetric(S * A + w * (dF * U + U * dF));
      second.col(c) = by_symmetric(w * (F * S + S * F));
    }
    out[i].compute(first + second);
    if (out[i].info() != Eigen::Success) out[i].compute(first);
  }
  return out;
}

/// What J'J of the rigid steps lacks: by omega_j twice, omega' (W - tr(W) I) omega with W = K U. Only where it is
/// positive.
void add_tension(const GraphEnergy& energy, const Polar& p, BlockMatrix& H) {
  const std::vector<GraphEnergy::Mat4> G = energy.linear_gradient(p.x);
  for (std::size_t i = 0; i < G.size(); ++i) {
    const Mat3 W = p.Q[i].transpose() * G[i].topLeftCorner<3, 3>() * p.U[i];
    Eigen::SelfAdjointEigenSolver<Mat3> eigen;
    eigen.computeDirect(0.5 * (W + W.transpose()) - W.trace() * Mat3::Identity());
    Eigen::Map<Eigen::Matrix<double, 6, 6>>(H.at(H.offsets[i])).topLeftCorner<3, 3>() +=
        eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0).asDiagonal() * eigen.eigenvectors().transpose();
  }
}

void hessian(const GraphEnergy& energy, const Polar& p, BlockMatrix& H) {
  GraphState rotations = p.x;
  for (std::size_t i = 0; i < p.Q.size(); ++i) rotations.R[energy.free_nodes()[i]] = p.Q[i];
  energy.hessian_rigid(rotations, H, p.U);
  add_tension(energy, p, H);
}

/// The rotation that takes the columns behind M = sum after before' there, from the identity on [Mueller et al., "A
/// robust method to extract the rotational part of deformations", 2016]: also where all lie in a plane.
Mat3 turn_of(const Mat3& M) {
  Mat3 R = Mat3::Identity();
  for (int step = 0; step < 20; ++step) {
    Vec3 axis = Vec3::Zero();
    double length = 1e-300;
    for (int c = 0; c < 3; ++c) {
      axis += R.col(c).cross(M.col(c));
      length += R.col(c).dot(M.col(c));
    }
    const Vec3 w = axis / std::abs(length);
    R = rotation_of(w) * R;
    if (w.squaredNorm() < 1e-8) break;  // a preconditioner needs no more digits
  }
  return R;
}

}  // namespace

std::vector<Mat3> turns_between(std::span<const Vec3> before, std::span<const Vec3> after,
                                std::span<const std::pair<Index, Index>> edges, std::span<const Index> free_nodes) {
  std::vector<Mat3> M(before.size(), Mat3::Zero());
  for (const auto& [j, k] : edges) {
    const Mat3 product = (after[k] - after[j]) * (before[k] - before[j]).transpose();
    M[j] += product;
    M[k] += product;
  }
  std::vector<Mat3> turns;
  for (const Index j : free_nodes) turns.push_back(turn_of(M[j]));
  return turns;
}

GaussNewtonResult minimise_polar(const GraphEnergy& energy, GraphState& x, KeptFactor& rigid,
                                 const GaussNewtonOptions& options) {
  Polar p = polar_of(energy, x), trial = p;
  const auto strain = strain_curvature(energy, p.U);
  GaussNewtonModel model;
  model.unknowns = 12 * energy.free_count();
  model.energy = [&] { return energy.energy(p.x, false).total(); };
  model.gradient = [&](std::span<double> g) { gradient(energy, p, g); };
  model.precondition = [&](const SparseCholesky& cholesky, std::span<double> g) {
    cholesky.solve(g.first(g.size() / 2));
    for (std::size_t i = 0; i < strain.size(); ++i)
      strain[i].solveInPlace(Eigen::Map<Vec6>(g.data() + g.size() / 2 + 6 * i));
  };
  model.try_step = [&](std::span<const double> s, double scale) { step(energy, p, s, scale, trial); };
  model.trial_energy = [&] { return energy.energy(trial.x, false).total(); };
  model.accept = [&] {
    std::swap(p, trial);
    x = p.x;
  };
  model.held = {1, 1, 1, 1e-3, 1e-3, 1e-3};  // as for rigid steps
  model.hessian = [&](BlockMatrix& H) { hessian(energy, p, H); };
  return gauss_newton(model, rigid, options);
}

}  // namespace sinew
