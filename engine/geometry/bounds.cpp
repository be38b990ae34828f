#include "engine/geometry/bounds.h"

namespace sinew {

Bounds bounds_of(std::span<const Eigen::Vector3d> points) {
  Bounds bounds;
  for (const Eigen::Vector3d& p : points)
    if (p.allFinite()) bounds.add(p);
  return bounds;
}

Normalization normalization_of(const Bounds& bounds) {
  const double diagonal = bounds.diagonal();
  return {bounds.centre(), diagonal > 0 ? 1 / diagonal : 1};
}

}  // namespace sinew
