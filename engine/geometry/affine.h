#pragma once
/// Linear parts of maps: their polar parts, and what lies between two of them.

#include <utility>

#include "engine/geometry/shape.h"

namespace sinew {

/// M = R S: R the rotation nearest to M (determinant +1), S symmetric.
std::pair<Mat3, Mat3> polar(const Mat3& M);

/// The share 1 - u of `first` and u of `second`: R by slerp, the short way, S linearly. Exact at equal ends.
Mat3 blended(const Mat3& first, const Mat3& second, double u);

}  // namespace sinew
