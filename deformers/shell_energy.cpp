#include "deformers/shell_energy.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/geometry/check.h"

namespace sinew {

namespace {

using std::numbers::pi;

double twice_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b - a).cross(c - a).norm();
}

/// Between -pi and pi.
double wrapped(double angle) {
  return angle - 2 * pi * std::nearbyint(angle / (2 * pi));
}

/// Each edge once in each direction: closed, and no triangle turned against its neighbours.
bool bounds_a_volume(std::span<const Triangle> triangles) {
  std::vector<std::pair<Index, Index>> sides;
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) sides.emplace_back(t[k], t[(k + 1) % 3]);
  std::sort(sides.begin(), sides.end());
  if (std::adjacent_find(sides.begin(), sides.end()) != sides.end()) return false;
  return std::all_of(sides.begin(), sides.end(), [&](const auto& side) {
    return std::binary_search(sides.begin(), sides.end(), std::pair(side.second, side.first));
  });
}

/// The order of slots: of corners a >= b.
std::size_t slot_of(std::size_t a, std::size_t b) {
  return a * (a + 1) / 2 + b;
}

/// H += factor g_a g_b', into the lower triangle.
void add_outer(BlockMatrix& H, std::size_t slot, bool swapped, const Vec3& ga, const Vec3& gb) {
  Eigen::Map<Mat3> block(H.at(slot));
  if (swapped)
    block += gb * ga.transpose();
  else
    block += ga * gb.transpose();
}

std::size_t entry_of(const BlockMatrix& H, Index row, Index column) {
  const auto begin = H.rows.begin() + H.offsets[column], end = H.rows.begin() + H.offsets[column + 1];
  const auto at = std::lower_bound(begin, end, row);
  CHECK(at != end && *at == row, row, column);
  return static_cast<std::size_t>(at - H.rows.begin());
}

}  // namespace

ShellEnergy::ShellEnergy(std::span<const std::vector<Vec3>> poses, std::span<const Triangle> triangles,
                         ShellStiffness stiffness, std::span<const Vec3> source)
    : triangles_(triangles.begin(), triangles.end()), edges_(shell_edges(triangles)) {
  CHECK(!poses.empty(), poses.size());
  const bool closed = bounds_a_volume(triangles);
  for (const std::vector<Vec3>& pose : poses) {
    lengths_.emplace_back();
    angles_.emplace_back();
    measure(pose, lengths_.back(), angles_.back());
    volumes_.push_back(closed ? volume_of(pose, triangles_) : 0);
  }
  std::vector<double> lengths = lengths_[0], angles = angles_[0];
  double volume = volumes_[0];
  if (!source.empty()) {
    lengths.clear();
    angles.clear();
    measure(source, lengths, angles);
    volume = closed ? volume_of(source, triangles_) : 0;
  }
  for (std::size_t k = 1; k < poses.size(); ++k) {
    for (std::size_t e = 0; e < edges_.size(); ++e) {
      const double share = source.empty() ? 1 : lengths[e] > 0 ? lengths_[0][e] / lengths[e] : 0;
      lengths_[k][e] = share * (lengths_[k][e] - lengths[e]);
      angles_[k][e] -= angles[e];
    }
    const double share = source.empty() ? 1 : volume != 0 ? volumes_[0] / volume : 0;
    volumes_[k] = share * (volumes_[k] - volume);
  }
  // Poses of another shape have areas of their own.
  const std::span<const std::vector<Vec3>> own = source.empty() ? poses : poses.first(1);
  for (const auto& [i, j, k] : triangles_) {
    double least = INFINITY;
    for (const std::vector<Vec3>& pose : own) least = std::min(least, twice_area(pose[i], pose[j], pose[k]));
    areas_.push_back(least);
  }
  weigh(own, stiffness);
  if (stiffness.learned && poses.size() > 1) learn();
  if (closed && std::abs(volumes_[0]) > 1e-9) w_v_ = std::sqrt(stiffness.nu) / std::abs(volumes_[0]);
  alpha_.assign(examples(), 0);
}

void ShellEnergy::measure(std::span<const Vec3> pose, std::vector<double>& lengths, std::vector<double>& angles) const {
  for (const ShellEdge& e : edges_) {
    lengths.push_back((pose[e.x[1]] - pose[e.x[0]]).norm());
    angles.push_back(e.hinge() ? dihedral_angle(pose[e.x[0]], pose[e.x[1]], pose[e.x[2]], pose[e.x[3]]) : 0);
  }
}

/// Eq. 8. An edge without length would weigh infinitely much: none weighs more than one of a thousandth of the mean.
void ShellEnergy::weigh(std::span<const std::vector<Vec3>> poses, ShellStiffness stiffness) {
  const std::vector<Vec3>& rest = poses[0];
  const std::size_t m = edges_.size();
  w_s_.assign(m, 0);
  w_b_.assign(m, 0);
  least_.assign(m, {0, 0});
  double mean = 0;
  for (const double L : lengths_[0]) mean += L / static_cast<double>(m);
  for (std::size_t e = 0; e < m; ++e) {
    const std::array<Index, 4>& x = edges_[e].x;
    const double L = lengths_[0][e], thin = 1e-6 * mean * mean;
    w_s_[e] = std::sqrt(stiffness.lambda) / std::max(L, 1e-3 * mean);
    if (!edges_[e].hinge()) continue;
    const double A1 = twice_area(rest[x[0]], rest[x[1]], rest[x[2]]) / 2;
    const double A2 = twice_area(rest[x[0]], rest[x[1]], rest[x[3]]) / 2;
    const bool folds = std::any_of(angles_.begin() + 1, angles_.end(),
                                   [&](const std::vector<double>& change) { return std::abs(change[e]) > pi; });
    folds_ += folds;
    least_[e] = {INFINITY, INFINITY};
    for (const std::vector<Vec3>& p : poses)
      for (std::size_t side : {0, 1})
        least_[e][side] = std::min(least_[e][side], least_area * twice_area(p[x[0]], p[x[1]], p[x[2 + side]]));
    if (folds || std::min(A1, A2) <= thin) continue;
    w_b_[e] = std::sqrt(stiffness.mu) * L / std::sqrt(A1 + A2);
  }
}

/// Appendix A, with epsilon a hundredth of the largest change: what stretches or bends most keeps a hundredth of the
/// stiffness.
void ShellEnergy::learn() {
  const auto scale = [&](const std::vector<std::vector<double>>& changes, std::vector<double>& weights) {
    std::vector<double> most(edges_.size(), 0);
    for (std::size_t k = 1; k < changes.size(); ++k)
      for (std::size_t e = 0; e < most.size(); ++e)
        if (weights[e] > 0) most[e] = std::max(most[e], std::abs(changes[k][e]));
    const double largest = *std::max_element(most.begin(), most.end());
    if (largest <= 0) return;
    for (std::size_t e = 0; e < most.size(); ++e) weights[e] *= std::sqrt(1 - most[e] / (1.01 * largest));
  };
  scale(lengths_, w_s_);
  scale(angles_, w_b_);
}

void ShellEnergy::set_unknowns(std::vector<Index> number, Index count, std::span<const double> factors) {
  number_ = std::move(number);
  count_ = count;
  active_.clear();
  const auto free = [&](Index v) { return v != ShellEdge::none && number_[v] != ShellEdge::none; };
  for (Index e = 0; e < edges_.size(); ++e) {
    const std::array<Index, 4>& x = edges_[e].x;
    const bool length = free(x[0]) || free(x[1]), angle = length || free(x[2]) || free(x[3]);
    const double factor = factors.empty() ? 1 : std::sqrt((factors[x[0]] + factors[x[1]]) / 2);
    Active a{e, length ? factor * w_s_[e] : 0, angle ? factor * w_b_[e] : 0, 0, 0, {}};
    if (a.w_s > 0 || a.w_b > 0) active_.push_back(a);
  }
  set_weights(std::vector<double>(alpha_));
}

void ShellEnergy::set_weights(std::span<const double> alpha) {
  CHECK(alpha.size() == examples(), alpha.size(), examples());
  alpha_.assign(alpha.begin(), alpha.end());
  volume_target_ = volumes_[0];
  for (std::size_t k = 0; k < alpha_.size(); ++k) volume_target_ += alpha_[k] * volumes_[k + 1];
  for (Active& a : active_) {
    a.length = lengths_[0][a.edge];
    a.angle = angles_[0][a.edge];
    for (std::size_t k = 0; k < alpha_.size(); ++k) {
      a.length += alpha_[k] * lengths_[k + 1][a.edge];
      a.angle += alpha_[k] * angles_[k + 1][a.edge];
    }
  }
}

double ShellEnergy::stretch(const Active& a, std::span<const Vec3> x) const {
  const std::array<Index, 4>& v = edges_[a.edge].x;
  return a.w_s * ((x[v[1]] - x[v[0]]).norm() - a.length);
}

double ShellEnergy::volume_residual(std::span<const Vec3> x) const {
  return w_v_ > 0 ? w_v_ * (volume_of(x, triangles_) - volume_target_) : 0;
}

ShellEnergy::Terms ShellEnergy::energy(std::span<const Vec3> x) const {
  Terms out;
  for (const Active& a : active_) {
    const double r = stretch(a, x);
    out.stretch += r * r / 2;
    if (a.w_b <= 0) continue;
    const std::array<Index, 4>& v = edges_[a.edge].x;
    const double s = a.w_b * wrapped(dihedral_angle(x[v[0]], x[v[1]], x[v[2]], x[v[3]]) - a.angle);
    out.bend += s * s / 2;
  }
  const double q = volume_residual(x);
  out.volume = q * q / 2;
  for (std::size_t c = 0; c < ties_.size(); ++c)
    out.tie += w_c * w_c / 2 * (ties_[c].at(x) - targets_[c]).squaredNorm();
  return out;
}

std::vector<Vec3> ShellEnergy::volume_gradient(std::span<const Vec3> x) const {
  std::vector<Vec3> out(x.size(), Vec3::Zero());
  for (const auto& [i, j, k] : triangles_) {
    out[i] += x[j].cross(x[k]) / 6;
    out[j] += x[k].cross(x[i]) / 6;
    out[k] += x[i].cross(x[j]) / 6;
  }
  return out;
}

template <class Visit>
void ShellEnergy::each_row(std::span<const Vec3> x, const Visit& visit) const {
  for (const Active& a : active_) {
    const std::array<Index, 4>& v = edges_[a.edge].x;
    const Vec3 e = x[v[1]] - x[v[0]];
    const double length = e.norm();
    const Vec3 g = length > 1e-15 ? Vec3(a.w_s / length * e) : Vec3(Vec3::Zero());
    visit(Row{a, std::array<Vec3, 2>{-g, g}, a.w_s * (length - a.length), a.w_s, lengths_});
    if (a.w_b <= 0) continue;
    Hinge hinge = hinge_at(x[v[0]], x[v[1]], x[v[2]], x[v[3]], least_[a.edge]);
    for (Vec3& h : hinge.gradient) h *= a.w_b;
    visit(Row{a, hinge.gradient, a.w_b * wrapped(hinge.theta - a.angle), a.w_b, angles_});
  }
}

void ShellEnergy::gradient(std::span<const Vec3> x, std::span<double> by_x, std::span<double> by_alpha) const {
  std::fill(by_x.begin(), by_x.end(), 0);
  std::fill(by_alpha.begin(), by_alpha.end(), 0);
  const auto add = [&](Index v, const Vec3& g) {
    if (number_[v] == ShellEdge::none) return;
    for (int c = 0; c < 3; ++c) by_x[3 * number_[v] + static_cast<std::size_t>(c)] += g[c];
  };
  each_row(x, [&](const Row& row) {
    const std::array<Index, 4>& v = edges_[row.edge.edge].x;
    for (std::size_t c = 0; c < row.gradients.size(); ++c) add(v[c], row.residual * row.gradients[c]);
    for (std::size_t k = 0; k < by_alpha.size(); ++k)
      by_alpha[k] -= row.residual * row.w * row.changes[k + 1][row.edge.edge];
  });
  if (w_v_ > 0) {
    const double q = w_v_ * volume_residual(x);
    const std::vector<Vec3> dv = volume_gradient(x);
    for (Index v = 0; v < x.size(); ++v) add(v, q * dv[v]);
    for (std::size_t k = 0; k < by_alpha.size(); ++k) by_alpha[k] -= q * volumes_[k + 1];
  }
  for (std::size_t c = 0; c < ties_.size(); ++c) {
    const Vec3 r = w_c * w_c * (ties_[c].at(x) - targets_[c]);
    const std::array<Mat3, 3> D = ties_[c].derivative(x);
    for (std::size_t i = 0; i < 3; ++i) add(ties_[c].corners[i], D[i].transpose() * r);
  }
}

BlockMatrix ShellEnergy::pattern() {
  const auto each_pair = [&](const auto& corners, const auto& visit) {
    for (std::size_t i = 0; i < corners.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        const bool both = corners[i] != ShellEdge::none && corners[j] != ShellEdge::none &&
                          number_[corners[i]] != ShellEdge::none && number_[corners[j]] != ShellEdge::none;
        visit(slot_of(i, j), both, both ? number_[corners[i]] : 0, both ? number_[corners[j]] : 0);
      }
  };
  const auto corners_of = [&](const Active& a) {
    std::array<Index, 4> v = edges_[a.edge].x;
    if (a.w_b <= 0) v[2] = v[3] = ShellEdge::none;
    return v;
  };
  std::vector<std::pair<Index, Index>> pairs;
  const auto collect = [&](std::size_t, bool both, Index i, Index j) {
    if (both) pairs.emplace_back(i, j);
  };
  for (const Active& a : active_) each_pair(corners_of(a), collect);
  for (const ShellTie& tie : ties_) each_pair(tie.corners, collect);
  BlockMatrix A = block_pattern(3, count_, pairs);
  for (Active& a : active_)
    each_pair(corners_of(a), [&](std::size_t slot, bool both, Index i, Index j) {
      a.slots[slot] = both ? entry_of(A, std::max(i, j), std::min(i, j)) : no_slot;
    });
  tie_slots_.resize(ties_.size());
  for (std::size_t c = 0; c < ties_.size(); ++c)
    each_pair(ties_[c].corners, [&](std::size_t slot, bool both, Index i, Index j) {
      tie_slots_[c][slot] = both ? entry_of(A, std::max(i, j), std::min(i, j)) : no_slot;
    });
  return A;
}

void ShellEnergy::hessian(std::span<const Vec3> x, BlockMatrix& A, Normal& rest) const {
  const std::size_t k = examples(), n = 3 * static_cast<std::size_t>(count_);
  std::fill(A.values.begin(), A.values.end(), 0);
  rest.B.assign(n * k, 0);
  rest.C.assign(k * k, 0);
  rest.u.assign(n + k, 0);
  each_row(x, [&](const Row& row) {
    const Index e = row.edge.edge;
    const std::array<Index, 4>& v = edges_[e].x;
    const std::span<const Vec3> g = row.gradients;
    for (std::size_t i = 0; i < g.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j)
        if (const std::size_t slot = row.edge.slots[slot_of(i, j)]; slot != no_slot)
          add_outer(A, slot, number_[v[i]] < number_[v[j]], g[i], g[j]);
    for (std::size_t p = 0; p < k; ++p) {
      const double change = -row.w * row.changes[p + 1][e];
      if (change == 0) continue;
      for (std::size_t i = 0; i < g.size(); ++i)
        if (number_[v[i]] != ShellEdge::none)
          for (std::size_t c = 0; c < 3; ++c)
            rest.B[p * n + 3 * number_[v[i]] + c] += change * g[i][static_cast<Eigen::Index>(c)];
      for (std::size_t q = 0; q < k; ++q) rest.C[p * k + q] -= change * row.w * row.changes[q + 1][e];
    }
  });
  for (std::size_t c = 0; c < ties_.size(); ++c) {
    const std::array<Mat3, 3> D = ties_[c].derivative(x);
    const Triangle& v = ties_[c].corners;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j <= i; ++j)
        if (const std::size_t slot = tie_slots_[c][slot_of(i, j)]; slot != no_slot) {
          const bool swapped = number_[v[i]] < number_[v[j]];
          const Mat3 product = w_c * w_c * (swapped ? D[j].transpose() * D[i] : D[i].transpose() * D[j]);
          Eigen::Map<Mat3>(A.at(slot)) += product;
        }
  }
  if (w_v_ <= 0) return;
  const std::vector<Vec3> dv = volume_gradient(x);
  for (Index v = 0; v < x.size(); ++v)
    if (number_[v] != ShellEdge::none)
      for (std::size_t c = 0; c < 3; ++c) rest.u[3 * number_[v] + c] = w_v_ * dv[v][static_cast<Eigen::Index>(c)];
  for (std::size_t p = 0; p < k; ++p) rest.u[n + p] = -w_v_ * volumes_[p + 1];
}

std::vector<double> ShellEnergy::response(std::span<const Vec3> x, std::span<const Vec3> d) const {
  const std::size_t k = examples(), n = 3 * static_cast<std::size_t>(count_);
  std::vector<double> out(n + k, 0);
  const auto add = [&](Index v, const Vec3& g) {
    if (number_[v] == ShellEdge::none) return;
    for (std::size_t c = 0; c < 3; ++c) out[3 * number_[v] + c] += g[static_cast<Eigen::Index>(c)];
  };
  each_row(x, [&](const Row& row) {
    const std::array<Index, 4>& v = edges_[row.edge.edge].x;
    double s = 0;
    for (std::size_t i = 0; i < row.gradients.size(); ++i) s += row.gradients[i].dot(d[v[i]]);
    if (s == 0) return;
    for (std::size_t i = 0; i < row.gradients.size(); ++i) add(v[i], s * row.gradients[i]);
    for (std::size_t p = 0; p < k; ++p) out[n + p] -= s * row.w * row.changes[p + 1][row.edge.edge];
  });
  for (const ShellTie& tie : ties_) {
    const std::array<Mat3, 3> D = tie.derivative(x);
    Vec3 s = Vec3::Zero();
    for (std::size_t i = 0; i < 3; ++i) s += w_c * w_c * (D[i] * d[tie.corners[i]]);
    for (std::size_t i = 0; i < 3; ++i) add(tie.corners[i], D[i].transpose() * s);
  }
  if (w_v_ <= 0) return out;
  const std::vector<Vec3> dv = volume_gradient(x);
  double s = 0;
  for (std::size_t v = 0; v < x.size(); ++v) s += w_v_ * w_v_ * dv[v].dot(d[v]);
  for (Index v = 0; v < x.size(); ++v) add(v, s * dv[v]);
  for (std::size_t p = 0; p < k; ++p) out[n + p] -= s * volumes_[p + 1];
  return out;
}

std::vector<double> ShellEnergy::best_weights(std::span<const Vec3> x,
                                              std::span<const std::optional<double>> pinned) const {
  const auto k = static_cast<Eigen::Index>(examples());
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(k, k);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(k), row(k);
  const auto add = [&](double w, double residual, const auto& change) {  // residual + w sum change (alpha_ - alpha)
    for (Eigen::Index p = 0; p < k; ++p) row[p] = w * change(static_cast<std::size_t>(p) + 1);
    for (Eigen::Index p = 0; p < k; ++p) residual += row[p] * alpha_[static_cast<std::size_t>(p)];
    C += row * row.transpose();
    b += residual * row;
  };
  for (const Active& a : active_) {
    const std::array<Index, 4>& v = edges_[a.edge].x;
    add(a.w_s, stretch(a, x), [&](std::size_t p) { return lengths_[p][a.edge]; });
    if (a.w_b <= 0) continue;
    const double s = a.w_b * wrapped(dihedral_angle(x[v[0]], x[v[1]], x[v[2]], x[v[3]]) - a.angle);
    add(a.w_b, s, [&](std::size_t p) { return angles_[p][a.edge]; });
  }
  if (w_v_ > 0) add(w_v_, volume_residual(x), [&](std::size_t p) { return volumes_[p]; });
  // Pinned ones: their rows say alpha = what they are pinned to.
  for (Eigen::Index p = 0; p < k; ++p) {
    const auto i = static_cast<std::size_t>(p);
    if (i >= pinned.size() || !pinned[i]) continue;
    b -= C.col(p) * *pinned[i];
    C.row(p).setZero();
    C.col(p).setZero();
    C(p, p) = 1;
    b[p] = *pinned[i];
  }
  C.diagonal() *= 1 + 1e-10;
  C.diagonal().array() += 1e-12;
  const Eigen::VectorXd alpha = C.ldlt().solve(b);
  if (!alpha.allFinite()) return alpha_;
  std::vector<double> out(alpha.data(), alpha.data() + alpha.size());
  for (std::size_t p = 0; p < std::min(out.size(), pinned.size()); ++p) out[p] = pinned[p].value_or(out[p]);
  return out;
}

std::size_t ShellEnergy::collapsed(std::span<const Vec3> x) const {
  std::size_t out = 0;
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& [i, j, k] = triangles_[t];
    out += twice_area(x[i], x[j], x[k]) < least_area * areas_[t];
  }
  return out;
}

std::vector<double> ShellEnergy::vertex_energies(std::span<const Vec3> x) const {
  std::vector<double> out(x.size(), 0);
  for (const Active& a : active_) {
    const std::array<Index, 4>& v = edges_[a.edge].x;
    const double r = stretch(a, x);
    double s = 0;
    if (a.w_b > 0) s = a.w_b * wrapped(dihedral_angle(x[v[0]], x[v[1]], x[v[2]], x[v[3]]) - a.angle);
    out[v[0]] += (r * r + s * s) / 4;
    out[v[1]] += (r * r + s * s) / 4;
  }
  return out;
}

}  // namespace sinew
