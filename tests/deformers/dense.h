#pragma once
/// A block matrix with both triangles, as a dense one, to check against.

#include <Eigen/Core>

#include "deformers/sparse_cholesky.h"

namespace sinew {

inline Eigen::MatrixXd dense(const BlockMatrix& H) {
  const Eigen::Index b = H.block;
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(H.size() * b, H.size() * b);
  for (Index j = 0; j < H.size(); ++j)
    for (Index e = H.offsets[j]; e < H.offsets[j + 1]; ++e) {
      const Eigen::Map<const Eigen::MatrixXd> M(H.at(e), b, b);
      D.block(H.rows[e] * b, j * b, b, b) = M;
      D.block(j * b, H.rows[e] * b, b, b) = M.transpose();
    }
  return D;
}

}  // namespace sinew
