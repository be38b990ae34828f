#include "engine/geometry/affine.h"

#include <Eigen/Geometry>
#include <numeric>

#include "engine/geometry/check.h"
#include "engine/geometry/rotation.h"

namespace sinew {

std::pair<Mat3, Mat3> polar(const Mat3& M) {
  const Mat3 R = nearest_rotation(M);
  return {R, R.transpose() * M};
}

Mat3 blended(const Mat3& first, const Mat3& second, double u) {
  if (first == second) return first;
  const auto [R0, S0] = polar(first);
  const auto [R1, S1] = polar(second);
  return Eigen::Quaterniond(R0).slerp(u, Eigen::Quaterniond(R1)).toRotationMatrix() * ((1 - u) * S0 + u * S1);
}

Affine rigid_fit(std::span<const Vec3> from, std::span<const Vec3> to) {
  CHECK(from.size() == to.size(), from.size(), to.size());
  const auto mean = [](std::span<const Vec3> points) {
    const Vec3 sum = std::accumulate(points.begin(), points.end(), Vec3(0, 0, 0));
    return Vec3(sum / std::max<double>(1, static_cast<double>(points.size())));
  };
  const Vec3 a = mean(from), b = mean(to);
  Mat3 C = Mat3::Zero();
  for (std::size_t i = 0; i < from.size(); ++i) C += (to[i] - b) * (from[i] - a).transpose();
  Affine out;
  out.leftCols<3>() = C.squaredNorm() > 0 ? nearest_rotation(C) : Mat3::Identity();
  out.col(3) = b - out.leftCols<3>() * a;
  return out;
}

}  // namespace sinew
