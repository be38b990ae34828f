#include "deformers/graph_energy.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace sinew {

namespace {

constexpr Index none = ~Index{0};

/// Columns a <= b of the six conditions c_a . c_b = delta_ab, in the order of eq. 5.
constexpr int condition[6][2] = {{0, 1}, {0, 2}, {1, 2}, {0, 0}, {1, 1}, {2, 2}};

double condition_residual(const Mat3& R, int n) {
  const auto [a, b] = condition[n];
  return R.col(a).dot(R.col(b)) - (a == b ? 1 : 0);
}

/// Derivative of condition n by the columns of R.
Eigen::Matrix<double, 9, 1> condition_gradient(const Mat3& R, int n) {
  const auto [a, b] = condition[n];
  Eigen::Matrix<double, 9, 1> J = Eigen::Matrix<double, 9, 1>::Zero();
  J.segment<3>(3 * a) += R.col(b);
  J.segment<3>(3 * b) += R.col(a);
  return J;
}

Mat3 cross_matrix(const Vec3& a) {
  Mat3 X;
  X << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return X;
}

}  // namespace

Mat3 rotation_of(const Vec3& w) {
  const double angle = w.norm();
  // sin(a)/a by the quaternion, finite at zero; normalising leaves no drift over many steps.
  const double half = angle < 1e-8 ? 0.5 : std::sin(0.5 * angle) / angle;
  return Eigen::Quaterniond(std::cos(0.5 * angle), half * w.x(), half * w.y(), half * w.z())
      .normalized()
      .toRotationMatrix();
}

void GraphEnergy::build(std::span<const Vec3> nodes, std::span<const std::pair<Index, Index>> edges,
                        const std::vector<bool>& free, std::span<const GraphHandle> handles,
                        const GraphWeights& weights) {
  weights_ = weights;
  sqrt_reg_ = std::sqrt(weights.regularization);
  free_nodes_.clear();
  unknown_of_.assign(nodes.size(), none);
  for (Index j = 0; j < nodes.size(); ++j)
    if (free[j]) {
      unknown_of_[j] = static_cast<Index>(free_nodes_.size());
      free_nodes_.push_back(j);
    }

  row_offsets_.assign(1, 0);
  entries_.clear();
  directed_.clear();
  const auto add_entry = [&](Index j) {
    if (free[j]) entries_.push_back({j, Vec4::Zero()});
  };
  for (const auto& edge : edges) {
    if (!free[edge.first] && !free[edge.second]) continue;  // both rest: the row is zero
    for (const auto& [j, k] : {edge, std::pair(edge.second, edge.first)}) {
      directed_.emplace_back(j, k);
      for (int row = 0; row < (weights.around > 0 ? 7 : 1); ++row) {
        add_entry(j);
        add_entry(k);
        row_offsets_.push_back(entries_.size());
      }
    }
  }
  regularization_rows_ = row_offsets_.size() - 1;
  edge_rows_ = weights.around > 0 ? 0 : regularization_rows_;
  for (const GraphHandle& handle : handles) {
    for (const Index j : handle.nodes) add_entry(j);
    row_offsets_.push_back(entries_.size());
  }
  build_A();
  move(nodes, handles);
}

/// The pattern of A, and the place in it of each product.
void GraphEnergy::build_A() {
  std::vector<std::pair<Index, Index>> pairs;
  for (std::size_t row = 0; row + 1 < row_offsets_.size(); ++row)
    for (std::size_t a = row_offsets_[row]; a < row_offsets_[row + 1]; ++a)
      for (std::size_t b = a + 1; b < row_offsets_[row + 1]; ++b)
        pairs.emplace_back(unknown_of_[entries_[a].node], unknown_of_[entries_[b].node]);
  A_ = block_pattern(4, static_cast<Index>(free_nodes_.size()), pairs);

  places_.clear();
  for (std::size_t row = 0; row + 1 < row_offsets_.size(); ++row)
    for (std::size_t a = row_offsets_[row]; a < row_offsets_[row + 1]; ++a)
      for (std::size_t b = row_offsets_[row]; b < row_offsets_[row + 1]; ++b) {
        const Index i = unknown_of_[entries_[a].node], j = unknown_of_[entries_[b].node];
        if (i < j) continue;
        const auto first = A_.rows.begin() + static_cast<std::ptrdiff_t>(A_.offsets[j]);
        const auto last = A_.rows.begin() + static_cast<std::ptrdiff_t>(A_.offsets[j + 1]);
        places_.push_back(static_cast<Index>(std::lower_bound(first, last, i) - A_.rows.begin()));
      }
}

void GraphEnergy::move(std::span<const Vec3> nodes, std::span<const GraphHandle> handles) {
  CHECK(nodes.size() == unknown_of_.size() && regularization_rows_ + handles.size() + 1 == row_offsets_.size(),
        nodes.size(), handles.size());
  const double reg = sqrt_reg_, con = std::sqrt(weights_.constraint);
  auto entry = entries_.begin();
  const auto put = [&](Index j, const Vec3& beta, double b) {
    if (unknown_of_[j] != none) (entry++)->coefficients << beta, b;
  };
  for (const auto& [j, k] : directed_) {
    const Vec3 d = reg * (nodes[k] - nodes[j]);
    put(j, d, reg);
    put(k, Vec3::Zero(), -reg);
    if (weights_.around == 0) continue;
    const double length = (nodes[k] - nodes[j]).norm(), share = std::sqrt(weights_.around);
    for (int c = 0; c < 6; ++c) {
      const Vec3 l = (c < 3 ? 1 : -1) * length * Vec3::Unit(c % 3);
      put(j, share * (d + reg * l), share * reg);
      put(k, -share * reg * l, -share * reg);
    }
  }
  handle_points_.clear();
  for (const GraphHandle& handle : handles) {
    for (std::size_t i = 0; i < handle.nodes.size(); ++i) {
      const double w = con * handle.weights[i];
      put(handle.nodes[i], w * (handle.v - nodes[handle.nodes[i]]), w);
    }
    handle_points_.push_back(handle.v);
  }
  CHECK(entry == entries_.end());
  rhs_.assign(handles.size(), Vec4::Zero());

  std::fill(A_.values.begin(), A_.values.end(), 0.0);
  auto place = places_.begin();
  for (std::size_t row = 0; row + 1 < row_offsets_.size(); ++row)
    for (std::size_t a = row_offsets_[row]; a < row_offsets_[row + 1]; ++a)
      for (std::size_t b = row_offsets_[row]; b < row_offsets_[row + 1]; ++b)
        if (unknown_of_[entries_[a].node] >= unknown_of_[entries_[b].node])
          Eigen::Map<Mat4>(A_.at(*place++)) += entries_[a].coefficients * entries_[b].coefficients.transpose();
}

void GraphEnergy::set_targets(std::span<const Vec3> targets) {
  CHECK(targets.size() == handle_points_.size(), targets.size(), handle_points_.size());
  for (std::size_t l = 0; l < targets.size(); ++l)
    rhs_[l].head<3>() = std::sqrt(weights_.constraint) * (targets[l] - handle_points_[l]);
}

std::vector<GraphEnergy::Mat4> GraphEnergy::displacements(const GraphState& x) {
  std::vector<Mat4> D(x.R.size(), Mat4::Zero());
  for (std::size_t j = 0; j < D.size(); ++j) {
    D[j].topLeftCorner<3, 3>() = x.R[j] - Mat3::Identity();
    D[j].topRightCorner<3, 1>() = x.t[j];
  }
  return D;
}

GraphEnergy::Vec4 GraphEnergy::residual(const std::vector<Mat4>& D, std::size_t row) const {
  const auto times = [](const Mat4& d, const Vec4& c) -> Vec4 {
    return (c[0] * d.col(0) + c[1] * d.col(1)) + (c[2] * d.col(2) + c[3] * d.col(3));
  };
  if (row < edge_rows_) {
    const auto [j, k] = directed_[row];
    Vec4 r = Vec4::Zero();
    if (unknown_of_[k] != none) r = -sqrt_reg_ * D[k].col(3);
    if (unknown_of_[j] != none) r += times(D[j], entries_[row_offsets_[row]].coefficients);
    return r;
  }
  Vec4 r = row < regularization_rows_ ? Vec4(Vec4::Zero()) : Vec4(-rhs_[row - regularization_rows_]);
  for (std::size_t e = row_offsets_[row]; e < row_offsets_[row + 1]; ++e)
    r += times(D[entries_[e].node], entries_[e].coefficients);
  return r;
}

GraphEnergy::Terms GraphEnergy::energy(const GraphState& x, bool rigid) const {
  Terms out;
  const std::vector<Mat4> D = displacements(x);
  for (std::size_t row = 0; row + 1 < row_offsets_.size(); ++row)
    (row < regularization_rows_ ? out.regularization : out.constraint) += residual(D, row).squaredNorm();
  if (!rigid)
    for (const Index j : free_nodes_)
      for (int n = 0; n < 6; ++n) {
        const double f = condition_residual(x.R[j], n);
        out.rotation += weights_.rotation * f * f;
      }
  return out;
}

std::vector<double> GraphEnergy::node_energy(const GraphState& x) const {
  std::vector<double> out(x.R.size(), 0.0);
  const std::vector<Mat4> D = displacements(x);
  for (std::size_t row = 0; row + 1 < row_offsets_.size(); ++row) {
    const double square = residual(D, row).squaredNorm();
    const auto entries = static_cast<double>(row_offsets_[row + 1] - row_offsets_[row]);
    for (std::size_t e = row_offsets_[row]; e < row_offsets_[row + 1]; ++e) out[entries_[e].node] += square / entries;
  }
  for (const Index j : free_nodes_)
    for (int n = 0; n < 6; ++n) {
      const double f = condition_residual(x.R[j], n);
      out[j] += weights_.rotation * f * f;
    }
  return out;
}

std::vector<GraphEnergy::Mat4> GraphEnergy::linear_gradient(const GraphState& x) const {
  const std::vector<Mat4> D = displacements(x);
  std::vector<Mat4> G(free_nodes_.size(), Mat4::Zero());
  for (std::size_t row = 0; row < edge_rows_; ++row) {
    const Vec4 r = residual(D, row);
    const Index j = unknown_of_[directed_[row].first], k = unknown_of_[directed_[row].second];
    if (j != none) G[j] += r * entries_[row_offsets_[row]].coefficients.transpose();
    if (k != none) G[k].col(3) -= sqrt_reg_ * r;
  }
  for (std::size_t row = edge_rows_; row + 1 < row_offsets_.size(); ++row) {
    const Vec4 r = residual(D, row);
    for (std::size_t e = row_offsets_[row]; e < row_offsets_[row + 1]; ++e)
      G[unknown_of_[entries_[e].node]] += r * entries_[e].coefficients.transpose();
  }
  return G;
}

void GraphEnergy::gradient_rigid(const GraphState& x, std::span<double> out) const {
  CHECK(out.size() == 6 * free_count(), out.size());
  const std::vector<Mat4> G = linear_gradient(x);
  for (std::size_t i = 0; i < G.size(); ++i) {
    const Eigen::Matrix<double, 3, 4> K =
        x.R[free_nodes_[i]].transpose() * G[i].topRows<3>();  // sum of (R'r) [beta, b]
    Eigen::Map<Eigen::Matrix<double, 6, 1>> g(out.data() + 6 * i);
    g << K(2, 1) - K(1, 2), K(0, 2) - K(2, 0), K(1, 0) - K(0, 1), K.col(3);  // beta x R'r, b R'r
  }
}

void GraphEnergy::gradient_affine(const GraphState& x, const std::vector<Mat3>& Q, std::span<double> out) const {
  CHECK(out.size() == 12 * free_count(), out.size());
  const std::vector<Mat4> G = linear_gradient(x);
  for (std::size_t i = 0; i < G.size(); ++i) {
    const Mat3& frame = Q[free_nodes_[i]];
    Eigen::Map<Eigen::Matrix<double, 3, 4>> g(out.data() + 12 * i);
    g = frame.transpose() * G[i].topRows<3>();
    const Mat3 S = frame.transpose() * x.R[free_nodes_[i]];
    Eigen::Map<Eigen::Matrix<double, 9, 1>> rotation(out.data() + 12 * i);
    for (int n = 0; n < 6; ++n) rotation += weights_.rotation * condition_residual(S, n) * condition_gradient(S, n);
  }
}

BlockMatrix GraphEnergy::hessian_pattern(int block) const {
  BlockMatrix H;
  H.block = block;
  H.offsets = A_.offsets;
  H.rows = A_.rows;
  H.values.assign(H.rows.size() * H.block_values(), 0.0);
  return H;
}

/// With J_i = R_i [-[beta_i]x, b_i] and Q = R_i' R_j, using Q [a]x = [Q a]x Q and [a]x [c]x = c a' - (a.c) I:
///   J_i' J_j = [ (tr(N) I - N') Q    [m]x Q ]      M = sum beta_i beta_j', m = sum beta_i b_j, N = M Q',
///              [ -Q [m*]x            a Q    ]      m* = sum b_i beta_j, a = sum b_i b_j, all of them entries of A.
void GraphEnergy::hessian_rigid(const GraphState& x, BlockMatrix& H, std::span<const Mat3> U) const {
  for (Index j = 0; j < A_.size(); ++j)
    for (Index e = A_.offsets[j]; e < A_.offsets[j + 1]; ++e) {
      const Mat3 Q = x.R[free_nodes_[A_.rows[e]]].transpose() * x.R[free_nodes_[j]];
      Mat4 a = Eigen::Map<const Mat4>(A_.at(e));
      if (!U.empty()) {
        a.topRows<3>() = U[A_.rows[e]] * a.topRows<3>().eval();
        a.leftCols<3>() = a.leftCols<3>().eval() * U[j];
      }
      const Mat3 N = a.topLeftCorner<3, 3>() * Q.transpose();
      Eigen::Map<Eigen::Matrix<double, 6, 6>> h(H.at(e));
      h.topLeftCorner<3, 3>() = (N.trace() * Mat3::Identity() - N.transpose()) * Q;
      h.topRightCorner<3, 3>() = cross_matrix(a.topRightCorner<3, 1>()) * Q;
      h.bottomLeftCorner<3, 3>() = -Q * cross_matrix(a.bottomLeftCorner<1, 3>().transpose());
      h.bottomRightCorner<3, 3>() = a(3, 3) * Q;
    }
}

void GraphEnergy::hessian_affine(const GraphState& x, const std::vector<Mat3>& Q, BlockMatrix& H) const {
  for (Index j = 0; j < A_.size(); ++j)
    for (Index e = A_.offsets[j]; e < A_.offsets[j + 1]; ++e) {
      const Mat3 q = Q[free_nodes_[A_.rows[e]]].transpose() * Q[free_nodes_[j]];
      const Eigen::Map<const Eigen::Matrix4d> a(A_.at(e));
      Eigen::Map<Eigen::Matrix<double, 12, 12>> h(H.at(e));
      for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) h.block<3, 3>(3 * r, 3 * c) = a(r, c) * q;
    }
  for (Index i = 0; i < A_.size(); ++i) {
    const Mat3 S = Q[free_nodes_[i]].transpose() * x.R[free_nodes_[i]];
    Eigen::Map<Eigen::Matrix<double, 12, 12>> h(H.at(A_.offsets[i]));
    for (int n = 0; n < 6; ++n) {
      const Eigen::Matrix<double, 9, 1> J = condition_gradient(S, n);
      h.topLeftCorner<9, 9>() += weights_.rotation * J * J.transpose();
    }
  }
}

GraphState GraphEnergy::step_rigid(const GraphState& x, std::span<const double> step, double scale) const {
  GraphState out = x;
  for (std::size_t i = 0; i < free_nodes_.size(); ++i) {
    const Index j = free_nodes_[i];
    const Eigen::Map<const Vec3> omega(step.data() + 6 * i), tau(step.data() + 6 * i + 3);
    out.t[j] += scale * (x.R[j] * tau);
    out.R[j] = x.R[j] * rotation_of(scale * omega);
  }
  return out;
}

GraphState GraphEnergy::step_affine(const GraphState& x, const std::vector<Mat3>& Q, std::span<const double> step,
                                    double scale) const {
  GraphState out = x;
  for (std::size_t i = 0; i < free_nodes_.size(); ++i) {
    const Index j = free_nodes_[i];
    const Eigen::Map<const Mat3> Delta(step.data() + 12 * i);
    const Eigen::Map<const Vec3> tau(step.data() + 12 * i + 9);
    out.R[j] += scale * (Q[j] * Delta);
    out.t[j] += scale * (Q[j] * tau);
  }
  return out;
}

std::pair<double, double> GraphEnergy::handle_error(const GraphState& x) const {
  const std::vector<Mat4> D = displacements(x);
  double sum = 0, largest = 0;
  for (std::size_t l = 0; l < rhs_.size(); ++l) {
    const double square = residual(D, regularization_rows_ + l).squaredNorm() / weights_.constraint;
    sum += square;
    largest = std::max(largest, square);
  }
  return {rhs_.empty() ? 0 : std::sqrt(sum / static_cast<double>(rhs_.size())), std::sqrt(largest)};
}

}  // namespace sinew
