#pragma once
/// The rotations nearest to many 3x3 matrices at a time, one in each lane of the processor's vectors.
///
/// R maximises tr(R' M). As a quaternion it is the eigenvector of the largest eigenvalue s of the symmetric traceless
/// 4x4 matrix N(M) [Horn 1987]; s is the largest root of its characteristic polynomial and found by Newton's iteration
/// from above [Theobald 2005]. det R = +1 whatever M is, so that nothing is mirrored [Stoll et al. 2007, eq. 2.6-2.8].

#include <array>
#include <cstddef>

#include "deformers/small_gemm.h"

namespace sinew {

inline constexpr std::size_t lane_count = gemm_lanes;
typedef double Lanes __attribute__((vector_size(lane_count * sizeof(double))));
using Mat3Lanes = std::array<Lanes, 9>;  ///< column by column

/// R <- the rotation nearest to M, near `R` as it was: that is the start where M allows no choice (a point, a line).
/// M is finite. Exact to about 1e-12 of the angle.
void nearest_rotations(const Mat3Lanes& M, Mat3Lanes& R);

}  // namespace sinew
