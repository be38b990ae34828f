#include "engine/geometry/affine.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace sinew {

std::pair<Mat3, Mat3> polar(const Mat3& M) {
  const Eigen::JacobiSVD<Mat3> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3 sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  const Mat3 R = svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
  return {R, R.transpose() * M};
}

Mat3 blended(const Mat3& first, const Mat3& second, double u) {
  if (first == second) return first;
  const auto [R0, S0] = polar(first);
  const auto [R1, S1] = polar(second);
  return Eigen::Quaterniond(R0).slerp(u, Eigen::Quaterniond(R1)).toRotationMatrix() * ((1 - u) * S0 + u * S1);
}

}  // namespace sinew
