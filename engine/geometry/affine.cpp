#include "engine/geometry/affine.h"

#include <Eigen/Geometry>

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

}  // namespace sinew
