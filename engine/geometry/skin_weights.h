#pragma once
/// SkinWeights: which affine maps each point follows, a sparse n-by-m matrix in CSR form, and Pose, the m maps.
///
///   p' = p + sum_j w_ij ((A_j - I) p + t_j)        (linear blend skinning; equals sum_j w_ij (A_j p + t_j) for sum w =
///   1)
///
/// Written as a displacement, a point whose maps are the identity keeps its bits, and so does a point with an empty
/// row. It is exact for all three methods, so one compute shader and one CPU twin move everything (design, section 1).

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/check.h"

namespace sinew {

/// [A | t]: p -> A p + t, in the shape's coordinates (relative to its origin, in its unit).
using Affine = Eigen::Matrix<double, 3, 4>;

inline Affine identity_map() {
  return Affine::Identity();
}

/// One map per graph node, tet, or shell face.
using Pose = std::vector<Affine>;

/// Whether bind() is to give SkinWeights::gradients.
enum class Gradients { No, Yes };

struct SkinWeights {
  std::vector<std::uint64_t> offsets{0};  ///< n + 1: row i is [offsets[i], offsets[i+1])
  std::vector<std::uint32_t> maps;        ///< index of a map
  std::vector<float> weights;             ///< sum to 1 in each row that is not empty

  /// Of each weight by the point's position, where weights are a function of space and gradients were asked for;
  /// otherwise empty. Then p' has the derivative J = M + sum_j (A_j p + t_j) grad w_ij^T, else J = M = sum_j w_ij A_j.
  std::vector<Eigen::Vector3f> gradients;

  std::size_t size() const { return offsets.size() - 1; }  ///< n, the number of points
  std::size_t influences() const { return maps.size(); }
};

}  // namespace sinew
