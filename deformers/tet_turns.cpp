// Rotation interpolation of tet_solver.h.

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "deformers/tet_solver.h"
#include "engine/geometry/affine.h"
#include "engine/geometry/check.h"

namespace sinew {

namespace {

Mat3 rotation_by(const Vec3& turn) {
  const double angle = turn.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Mat3::Identity();
}

Vec3 turn_of(const Mat3& R) {
  const Eigen::AngleAxisd turn(R);
  return turn.angle() * turn.axis();
}

Vec3 mean(const std::vector<Vec3>& points) {
  return std::accumulate(points.begin(), points.end(), Vec3(0, 0, 0)) / static_cast<double>(points.size());
}

/// Whether points lie on more than a line, so that where they go fixes a rotation.
bool fix_rotation(const std::vector<Vec3>& points) {
  if (points.size() < 3) return false;
  const Vec3 centre = mean(points);
  Mat3 C = Mat3::Zero();
  for (const Vec3& p : points) C += (p - centre) * (p - centre).transpose();
  const Eigen::JacobiSVD<Mat3> svd(C);
  return svd.singularValues()[1] > 1e-4 * svd.singularValues()[0];
}

/// Vertices of a handle, then its ties, where they are in x.
std::vector<Vec3> points_of(const TetHandle& handle, const std::vector<Vec3>& x) {
  std::vector<Vec3> out;
  for (const Index v : handle.vertices) out.push_back(x[v]);
  for (const TetTie& tie : handle.ties) out.push_back(tie.at(x));
  return out;
}

std::vector<Vec3> chosen(const std::vector<Vec3>& all, const std::vector<Index>& which) {
  std::vector<Vec3> out;
  out.reserve(which.size());
  for (const Index v : which) out.push_back(all[v]);
  return out;
}

}  // namespace

/// How far each handle is to turn from where it is now: what it is turned by on the way, where that is told, else by
/// less than half a turn.
std::vector<Vec3> TetSolver::turns_to(std::span<const TetTarget> targets) const {
  std::vector<Vec3> out(targets.size(), Vec3::Zero());
  for (std::size_t h = 0; h < targets.size(); ++h) {
    const TetHandle& handle = constraints_.handles[h];
    if (!fix_rotation(points_of(handle, rest_))) continue;
    out[h] = turn_of(rigid_fit(points_of(handle, x_), targets[h].positions).leftCols<3>());
    if (!targets[h].turn) continue;
    const bool known = from_rest_ || last_turns_[h].has_value();
    if (!known) continue;
    const Vec3 last = from_rest_ ? Vec3(0, 0, 0) : *last_turns_[h];
    // Turns about one axis add up; then the whole turns between are known, too.
    if (last.cross(*targets[h].turn).norm() <= 1e-9 * last.norm() * targets[h].turn->norm())
      out[h] = *targets[h].turn - last;
  }
  return out;
}

/// h_k of each handle that fixes a rotation, in each tet the mean of its corners.
void TetSolver::make_fields() {
  std::vector<Index> number(rest_.size(), 0);
  std::vector<double> owner(rest_.size(), 0);  // 1 + handle that a held vertex belongs to
  const auto hold = [&](const std::vector<Index>& vertices, double as) {
    if (!fix_rotation(chosen(rest_, vertices))) return;
    for (const Index v : vertices) {
      number[v] = TetEnergy::none;
      owner[v] = as;
    }
  };
  // One handle and nothing fixed: all goes with it.
  fields_.assign(constraints_.handles.size(), {});
  if (constraints_.fixed.empty() && constraints_.handles.size() == 1) {
    fields_[0].assign(tets_.size(), 1);
    return;
  }
  hold(constraints_.fixed, 0);
  for (std::size_t h = 0; h < constraints_.handles.size(); ++h)
    hold(constraints_.handles[h].vertices, static_cast<double>(h) + 1);
  // Parts of the solid without any of these have no turn to take part in; the shift keeps the matrix definite there.
  Index count = 0;
  std::vector<Index> free;
  for (Index v = 0; v < rest_.size(); ++v)
    if (number[v] != TetEnergy::none) {
      number[v] = count++;
      free.push_back(v);
    }
  if (count == 0) return;
  BlockMatrix L = energy_.laplacian(number, count, TetEnergy::Ties::No);
  const BlockMatrix all = energy_.laplacian();
  double largest = 0;
  for (Index j = 0; j < count; ++j) largest = std::max(largest, L.values[L.offsets[j]]);
  for (Index j = 0; j < count; ++j) L.values[L.offsets[j]] += 1e-10 * largest;
  SparseCholesky cholesky;
  cholesky.analyse(L);
  if (!cholesky.factorize(L)) return;
  for (std::size_t h = 0; h < constraints_.handles.size(); ++h) {
    if (!fix_rotation(chosen(rest_, constraints_.handles[h].vertices))) continue;
    std::vector<double> u(rest_.size(), 0), Lu(rest_.size()), b(count);
    for (Index v = 0; v < rest_.size(); ++v) u[v] = owner[v] == static_cast<double>(h) + 1 ? 1 : 0;
    multiply(all, u, Lu);
    for (Index i = 0; i < count; ++i) b[i] = -Lu[free[i]];
    cholesky.solve(b);
    for (Index i = 0; i < count; ++i) u[free[i]] = b[i];
    std::vector<float>& field = fields_[h];
    field.resize(tets_.size());
    for (Index j = 0; j < tets_.size(); ++j) {
      double sum = 0;
      for (const Index v : tets_[j]) sum += u[v];
      field[j] = static_cast<float>(std::clamp(sum / 4, 0.0, 1.0));
    }
  }
}

/// R_j <- q_j R_j with q_j the harmonic blend of the handles' quaternions [section 2.3.2, rotation interpolation].
void TetSolver::turn_rotations(std::span<const Vec3> turns) {
  if (fields_.empty()) make_fields();
  std::vector<Eigen::Quaterniond> q;
  for (const Vec3& turn : turns) {
    q.emplace_back(rotation_by(turn));
    if (q.back().w() < 0) q.back().coeffs() *= -1;
  }
  for (Index j = 0; j < tets_.size(); ++j) {
    Eigen::Vector4d sum(0, 0, 0, 0);
    double held = 1;
    for (std::size_t h = 0; h < turns.size(); ++h) {
      if (fields_[h].empty()) continue;
      sum += static_cast<double>(fields_[h][j]) * q[h].coeffs();
      held -= static_cast<double>(fields_[h][j]);
    }
    sum.w() += held;
    const Eigen::Quaterniond blend(sum);
    energy_.set_rotation(j, blend.normalized().toRotationMatrix() * energy_.rotation(j));
  }
}

/// Takes the handles to the targets by turns of at most 30 degrees.
void TetSolver::turn_handles(std::span<const TetTarget> targets, std::span<const Vec3> turns) {
  double widest = 0;
  for (const Vec3& turn : turns) widest = std::max(widest, turn.norm());
  if (widest < 1e-6 || !interpolate_ || given_rotations_ || free_.empty()) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(widest / (std::numbers::pi / 6))));
  const std::vector<Vec3> start = x_;
  std::vector<TetTarget> way(targets.begin(), targets.end());
  std::vector<Vec3> part(turns.begin(), turns.end());
  for (Vec3& turn : part) turn /= steps;
  std::vector<Vec3> g(rest_.size());
  for (int s = 1; s <= steps; ++s) {
    const double u = static_cast<double>(s) / steps;
    for (std::size_t h = 0; h < targets.size(); ++h) {
      const TetHandle& handle = constraints_.handles[h];
      const std::vector<Vec3> from = points_of(handle, start);
      if (from.empty()) continue;
      const std::vector<Vec3>& to = targets[h].positions;
      const Vec3 a = mean(from), b = mean(to);
      const Mat3 back = rotation_by(-turns[h]), now = rotation_by(u * turns[h]);
      for (std::size_t i = 0; i < from.size(); ++i) {
        const Vec3 begin = from[i] - a, end = back * (to[i] - b);
        way[h].positions[i] = (1 - u) * a + u * b + now * (begin + u * (end - begin));
      }
    }
    place(way);
    turn_rotations(part);
    if (!linear_step(TetEnergy::Rotations::Kept)) return;
    energy_.evaluate(x_, TetEnergy::Rotations::Nearest, g);
  }
}

}  // namespace sinew
