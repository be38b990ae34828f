#include "engine/geometry/gaussian.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace sinew {

namespace {

constexpr double flat = 1e-15;  ///< of the longest axis

Mat3 rotation_of(const Eigen::Vector4d& q) {
  return Eigen::Quaterniond(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
}

bool has_extent(const Gaussian& g) {
  const double norm = g.quaternion.stableNorm(), longest = g.log_scales.maxCoeff();
  return norm > 0 && std::isfinite(norm) && !g.log_scales.hasNaN() && std::isfinite(longest);
}

/// Turns each two columns in their plane until all are orthogonal. Columns that are so already stay as they are.
void orthogonalise(Mat3& B) {
  constexpr std::array<std::pair<int, int>, 3> pairs{{{0, 1}, {0, 2}, {1, 2}}};
  constexpr double rounding = 1e-15;
  bool turned = true;
  for (int sweep = 0; turned && sweep < 20; ++sweep) {
    turned = false;
    for (const auto& [p, q] : pairs) {
      const double a = B.col(p).norm(), b = B.col(q).norm(), c = B.col(p).dot(B.col(q));
      if (!(std::abs(c) > rounding * a * b)) continue;
      turned = true;
      const double zeta = (b - a) * (b + a) / (2 * c);
      const double tangent = std::copysign(1 / (std::abs(zeta) + std::hypot(1, zeta)), zeta);
      const double cosine = 1 / std::hypot(1, tangent), sine = cosine * tangent;
      const Vec3 column = B.col(p);
      B.col(p) = cosine * column - sine * B.col(q);
      B.col(q) = sine * column + cosine * B.col(q);
    }
  }
}

/// Unit vectors along the columns of B; along one of no length, what is perpendicular to the others and, where that
/// leaves a choice, nearest to the column of `like`.
Mat3 directions_of(const Mat3& B, const Vec3& lengths, const Mat3& like) {
  Mat3 U;
  std::array<int, 3> order{0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int a, int b) { return lengths[a] > lengths[b]; });
  const double limit = flat * lengths[order[0]];
  for (int n = 0; n < 3; ++n) {
    const int k = order[static_cast<std::size_t>(n)];
    if (lengths[k] > limit) {
      U.col(k) = B.col(k) / lengths[k];
    } else if (n == 2) {
      U.col(k) = U.col(order[0]).cross(U.col(order[1])).normalized();
    } else {
      const Vec3 first = U.col(order[0]);
      Vec3 across = like.col(k) - first * first.dot(like.col(k));
      if (across.norm() < 1e-3) across = first.unitOrthogonal();
      U.col(k) = across.normalized();
    }
  }
  return U;
}

/// For each axis of `like` the column of U that becomes it.
std::array<int, 3> nearest_order(const Mat3& U, const Mat3& like) {
  const Mat3 nearness = (like.transpose() * U).cwiseAbs();
  std::array<int, 3> order{0, 1, 2}, best = order;
  double most = -1;
  do {
    const double sum = nearness(0, order[0]) + nearness(1, order[1]) + nearness(2, order[2]);
    if (sum > most) {
      most = sum;
      best = order;
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

/// Columns turned round so that they point as those of `like` do, and form a rotation.
void choose_signs(Mat3& U, const Mat3& like) {
  const Vec3 nearness = (like.transpose() * U).diagonal();
  for (int k = 0; k < 3; ++k)
    if (nearness[k] < 0) U.col(k) = -U.col(k);
  int least = 0;
  nearness.cwiseAbs().minCoeff(&least);
  if (U.determinant() < 0) U.col(least) = -U.col(least);
}

}  // namespace

Mat3 covariance(const Gaussian& gaussian) {
  const Mat3 R = rotation_of(gaussian.quaternion);
  return R * (2 * gaussian.log_scales).array().exp().matrix().asDiagonal() * R.transpose();
}

Gaussian bent(const Gaussian& gaussian, const Mat3& J, const Mat3& Q) {
  if (!has_extent(gaussian) || !J.allFinite()) return gaussian;
  const double longest = gaussian.log_scales.maxCoeff();
  const Mat3 R = rotation_of(gaussian.quaternion), like = Q * R;
  const Vec3 scales = (gaussian.log_scales.array() - longest).exp();
  Mat3 B = J * R * scales.asDiagonal();
  orthogonalise(B);
  const Vec3 lengths = B.colwise().norm();
  const double limit = flat * lengths.maxCoeff();
  if (!(limit > 0) || !std::isfinite(limit)) return gaussian;
  const Mat3 U = directions_of(B, lengths, like);
  const std::array<int, 3> order = nearest_order(U, like);
  Gaussian out;
  Mat3 frame;
  for (int k = 0; k < 3; ++k) {
    const int from = order[static_cast<std::size_t>(k)];
    frame.col(k) = U.col(from);
    out.log_scales[k] = longest + std::log(std::max(lengths[from], limit));
    if (lengths[from] <= limit) out.log_scales[k] = std::min(out.log_scales[k], gaussian.log_scales[from]);
  }
  choose_signs(frame, like);
  const Eigen::Quaterniond q(frame);
  out.quaternion = Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()).normalized() * gaussian.quaternion.stableNorm();
  if (out.quaternion.dot(gaussian.quaternion) < 0) out.quaternion = -out.quaternion;
  return out;
}

}  // namespace sinew
