#include "engine/geometry/rotation.h"

#include <Eigen/LU>
#include <Eigen/SVD>

namespace sinew {

Mat3 nearest_rotation(const Mat3& M) {
  // Newton's iteration for the polar factor [Higham 1986] where M is near a rotation: a tenth of the time of the
  // singular values.
  Mat3 Q = M;
  for (int step = 0; step < 12; ++step) {
    const double determinant = Q.determinant();
    if (!(determinant > 0.1 && determinant < 10)) break;
    const Mat3 next = 0.5 * (Q + Q.inverse().transpose());
    const double change = (next - Q).cwiseAbs().maxCoeff();
    Q = next;
    if (change < 1e-8) return Q;  // the next change would be its square
  }
  const Eigen::JacobiSVD<Mat3> svd(M, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vec3 sign(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1);
  return svd.matrixU() * sign.asDiagonal() * svd.matrixV().transpose();
}

}  // namespace sinew
