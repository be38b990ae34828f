#pragma once
/// The rotation in a linear map.

#include "engine/geometry/shape.h"

namespace sinew {

/// The rotation (determinant +1) nearest to M by the Frobenius norm: the orthogonal factor of its polar decomposition
/// where det M > 0, else with the axis of least stretch turned round. M is finite.
Mat3 nearest_rotation(const Mat3& M);

}  // namespace sinew
