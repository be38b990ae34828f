#pragma once
/// Linear parts of maps: their polar parts, and what lies between two of them.

#include <span>
#include <utility>

#include "engine/geometry/shape.h"
#include "engine/geometry/skin_weights.h"

namespace sinew {

/// M = R S: R the rotation nearest to M (determinant +1), S symmetric.
std::pair<Mat3, Mat3> polar(const Mat3& M);

/// The share 1 - u of `first` and u of `second`: R by slerp, the short way, S linearly. Exact at equal ends.
Mat3 blended(const Mat3& first, const Mat3& second, double u);

/// The rotation and translation that bring `from` nearest to `to`, in the sum of squares; as many points of each. The
/// rotation is the identity where nothing tells of one (no two different points).
Affine rigid_fit(std::span<const Vec3> from, std::span<const Vec3> to);

}  // namespace sinew
