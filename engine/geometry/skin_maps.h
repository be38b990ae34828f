#pragma once
/// What skin.cpp and skin_attributes.cpp share: the maps of a pose as displacements, and their blend at a point.

#include <vector>

#include "engine/geometry/skin_weights.h"

namespace sinew {

/// [A - I | t], or [Adot | tdot], column by column, padded to whole vectors of four.
using Padded = Eigen::Matrix<double, 4, 4>;

/// `minus` is what is taken from each map: identity_map() for a pose, zero for its rate.
inline std::vector<Padded> padded(const Pose& pose, const Affine& minus) {
  std::vector<Padded> out(pose.size());
  for (std::size_t j = 0; j < pose.size(); ++j) {
    out[j].setZero();
    out[j].topRows<3>() = pose[j] - minus;
  }
  return out;
}

/// Sum of the maps of row i, in the row's order.
inline Padded blend(const SkinWeights& weights, const std::vector<Padded>& D, std::size_t i) {
  Padded sum = Padded::Zero();
  for (std::uint64_t e = weights.offsets[i]; e < weights.offsets[i + 1]; ++e)
    sum += static_cast<double>(weights.weights[e]) * D[weights.maps[e]];
  return sum;
}

/// What a map of D does to p: its displacement, or its velocity.
inline Eigen::Vector3d at(const Padded& D, const Eigen::Vector3d& p) {
  return D.topLeftCorner<3, 3>() * p + D.topRightCorner<3, 1>();
}

}  // namespace sinew
