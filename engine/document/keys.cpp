#include "engine/document/keys.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "engine/document/selection.h"
#include "engine/geometry/affine.h"
#include "engine/geometry/check.h"

namespace sinew::document {

namespace {

Vec3 mean_of(std::span<const Vec3> points) {
  return std::accumulate(points.begin(), points.end(), Vec3(0, 0, 0)) / static_cast<double>(points.size());
}

/// A motion relative to the mean of its points: the symbols of keys.h.
struct Relative {
  Vec3 axis = Vec3::UnitZ();
  double degrees = 0;
  Vec3 a = Vec3::Zero();
  Mat3 A = Mat3::Identity();
  Vec3 b = Vec3::Zero();
  Vec3 m = Vec3::Zero();
  std::vector<Vec3> o;  ///< empty: zero

  Mat3 R() const { return Eigen::AngleAxisd(degrees * (std::numbers::pi / 180), axis).toRotationMatrix(); }
};

Relative relative(const Motion& motion, std::span<const Vec3> at, const Vec3& origin) {
  Relative out;
  const Vec3 c = mean_of(at);
  if (const std::vector<Vec3>& to = motion.to.get(); !to.empty()) {
    CHECK(to.size() == at.size(), to.size(), at.size());
    for (std::size_t i = 0; i < to.size(); ++i) out.o.push_back(to[i] - origin - at[i]);
  }
  if (motion.rotate) {
    out.axis = motion.rotate->axis.stableNormalized();
    out.degrees = motion.rotate->degrees;
    if (motion.rotate->about) out.a = *motion.rotate->about - origin - c;
  }
  if (motion.matrix) {
    out.A = motion.matrix->topLeftCorner<3, 3>();
    out.b = (out.A - Mat3::Identity()) * (c + origin) + motion.matrix->topRightCorner<3, 1>();
  }
  if (motion.move) out.m = *motion.move;
  return out;
}

/// Makes the rotations of two motions turn about one axis and pivot, so that degrees alone differ; false where they
/// can't.
bool same_axis(Relative& first, Relative& second) {
  if (first.degrees == 0) std::tie(first.axis, first.a) = std::pair(second.axis, second.a);
  if (second.degrees == 0) std::tie(second.axis, second.a) = std::pair(first.axis, first.a);
  if (first.axis.dot(second.axis) < 0) {
    second.axis = -second.axis;
    second.degrees = -second.degrees;
  }
  return (first.axis - second.axis).norm() <= 1e-12;
}

/// Pivots that go along with the handle's mean are the same but for rounding.
bool same_pivot(const Relative& first, const Relative& second, double extent) {
  return (first.a - second.a).norm() <= 1e-9 * extent;
}

/// The rotation about c, and what it does to c moved into b: R (p - c - a) + a = R (p - c) + (a - R a).
void turn_about_mean(Relative& motion, Mat3& R) {
  R = motion.R();
  motion.b += motion.A * (motion.a - R * motion.a);
  motion.a.setZero();
}

}  // namespace

KeySpan span_of(std::span<const Key> keys, double frame) {
  CHECK(!keys.empty());
  const auto after = std::find_if(keys.begin(), keys.end(), [&](const Key& key) { return key.frame > frame; });
  const auto second = static_cast<std::size_t>(after - keys.begin());
  if (second == 0) return {0, 0, 0};
  if (second == keys.size()) return {second - 1, second - 1, 0};
  const Key &first = keys[second - 1], &last = keys[second];
  const double u = (frame - first.frame) / (static_cast<double>(last.frame) - first.frame);
  switch (first.interpolation) {
    case Interpolation::Hold: return {second - 1, second - 1, 0};
    case Interpolation::Smooth: return {second - 1, second, u * u * (3 - 2 * u)};
    case Interpolation::Linear: break;
  }
  return {second - 1, second, u};
}

Motion motion_between(const Motion& first, const Motion& second, double u, std::span<const Vec3> at_first,
                      std::span<const Vec3> at_second, std::span<const Vec3> now, const Vec3& origin) {
  CHECK(at_first.size() == now.size() && at_second.size() == now.size(), at_first.size(), now.size());
  Relative x = relative(first, at_first, origin), y = relative(second, at_second, origin);
  const Vec3 c = mean_of(now);
  double extent = 1e-300;
  for (const Vec3& p : now) extent = std::max(extent, (p - c).norm());
  extent = std::max({extent, x.a.norm(), y.a.norm()});

  Rotation rotation{x.axis, 0, Vec3(c + origin)};
  if (same_axis(x, y) && same_pivot(x, y, extent)) {
    rotation = {x.axis, (1 - u) * x.degrees + u * y.degrees, Vec3(c + x.a + origin)};
  } else {
    Mat3 R, other;
    turn_about_mean(x, R);
    turn_about_mean(y, other);
    const Eigen::AngleAxisd turn(blended(R, other, u));
    rotation.axis = turn.axis();
    rotation.degrees = turn.angle() * (180 / std::numbers::pi);
  }
  const Vec3 b = (1 - u) * x.b + u * y.b, move = (1 - u) * x.m + u * y.m;
  Motion out;
  if (x.o.empty() && y.o.empty()) {
    const Mat3 A = blended(x.A, y.A, u);
    if (rotation.degrees != 0) out.rotate = rotation;
    out.move = move;
    if (A == Mat3::Identity()) {
      *out.move += b;
    } else {
      // A (q - c) + c + b = A q + t, in the file's coordinates.
      out.matrix = Eigen::Matrix4d::Identity();
      out.matrix->topLeftCorner<3, 3>() = A;
      out.matrix->topRightCorner<3, 1>() = (Mat3::Identity() - A) * (c + origin) + b;
    }
    return out;
  }
  // Targets of their own leave nothing but targets.
  const Mat3 R = Eigen::AngleAxisd(rotation.degrees * (std::numbers::pi / 180), rotation.axis).toRotationMatrix();
  const Mat3 A = blended(x.A, y.A, u);
  const Vec3 about = *rotation.about - origin;
  std::vector<Vec3> targets;
  for (std::size_t i = 0; i < now.size(); ++i) {
    Vec3 p = A * (R * (now[i] - about) + about - c) + c + b + move;
    if (!x.o.empty()) p += (1 - u) * x.o[i];
    if (!y.o.empty()) p += u * y.o[i];
    targets.push_back(p + origin);
  }
  out.to = Shared<Vec3>(std::move(targets));
  return out;
}

std::vector<Vec3> targets_between(const Motion& first, const Motion& second, double u, std::span<const Vec3> at_first,
                                  std::span<const Vec3> at_second, std::span<const Vec3> now, const Vec3& origin) {
  return targets_of(motion_between(first, second, u, at_first, at_second, now, origin), now, origin);
}

std::vector<std::optional<double>> weights_between(std::span<const std::optional<double>> first,
                                                   std::span<const std::optional<double>> second, double u) {
  std::vector<std::optional<double>> out(std::max(first.size(), second.size()));
  for (std::size_t k = 0; k < std::min(first.size(), second.size()); ++k)
    if (first[k] && second[k]) out[k] = u == 0 ? *first[k] : *first[k] + u * (*second[k] - *first[k]);
  return out;
}

}  // namespace sinew::document
