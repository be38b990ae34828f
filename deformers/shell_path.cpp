#include "deformers/shell_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "engine/geometry/affine.h"

namespace sinew {

namespace {

Mat3 rotation_by(const Vec3& turn) {
  const double angle = turn.norm();
  return angle > 0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Mat3::Identity();
}

}  // namespace

void ShellPath::set(Index point, const Vec3& from, const Vec3& to) {
  from_[point] = from;
  to_[point] = to;
}

void ShellPath::add_body(std::vector<Index> points, std::optional<Vec3> turn, double unit) {
  if (points.empty()) return;
  std::vector<Vec3> from, to;
  for (const Index i : points) {
    from.push_back(from_[i]);
    to.push_back(to_[i]);
  }
  const Affine fit = rigid_fit(from, to);
  Body body;
  body.points = std::move(points);
  body.centre = std::accumulate(from.begin(), from.end(), Vec3(0, 0, 0)) / static_cast<double>(from.size());
  body.move = fit.leftCols<3>() * body.centre + fit.col(3) - body.centre;
  // A turn that the targets do not show (a scale, a mirror, single points) is none of these.
  if (turn && (rotation_by(*turn) - fit.leftCols<3>()).norm() < 1e-3) {
    body.turn = *turn;
  } else {
    const Eigen::AngleAxisd best(Mat3(fit.leftCols<3>()));
    body.turn = best.angle() * best.axis();
  }
  const double turns = body.turn.norm() / (std::numbers::pi / 9), moves = body.move.norm() / (0.15 * unit);
  stretches_ = std::max(stretches_, static_cast<int>(std::clamp(std::ceil(std::max(turns, moves) - 1e-9), 1.0, 40.0)));
  bodies_.push_back(std::move(body));
}

std::vector<Vec3> ShellPath::at(double share) const {
  if (share >= 1) return to_;
  std::vector<Vec3> out(from_.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = from_[i] + share * (to_[i] - from_[i]);
  for (const Body& body : bodies_) {
    const Mat3 whole = rotation_by(body.turn), part = rotation_by(share * body.turn);
    for (const Index i : body.points) {
      const Vec3 p = from_[i] - body.centre;
      const Vec3 beyond = to_[i] - (body.centre + body.move + whole * p);  // what no rigid motion does
      out[i] = body.centre + share * body.move + part * p + share * beyond;
    }
  }
  return out;
}

}  // namespace sinew
