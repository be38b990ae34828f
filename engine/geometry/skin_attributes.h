#pragma once
/// What a deformation does to attributes, by their kind [Sumner et al. 2007, section 3, generalised].
///
///   M    = sum_j w_j A_j                                      blended 3x3 of the point
///   J    = M + sum_j (A_j p + t_j) grad w_j^T                 derivative of the bent point by p; M without gradients
///   v'   = J v + sum_j w_j (dA_j/dt p + dt_j/dt)              of a Velocity: the second part is the rate of the map
///   S'   = J S J^T                                            of a Quaternion with a LogScale: gaussian.h
///   c'_l = D_l(Q) c_l, Q the rotation nearest to J            of SphericalHarmonics: harmonics.h; band 0 is unchanged
///
/// p is the rest point relative to the shape's origin. Gradients of a row sum to zero, so (A_j p + t_j) is taken as the
/// difference of the displacements of map j and of the row's first: points that all maps move alike have J = M exactly.

#include "engine/geometry/shape.h"
#include "engine/geometry/skin_weights.h"

namespace sinew {

/// `out` is a copy of `rest` whose attributes are bent here. A value of several points has the mean of their J. What
/// does not come out finite stays as it was. Threads do not change a bit.
void bend_attributes(const Shape& rest, const SkinWeights& weights, const Pose& pose, const Pose* rate, Shape& out);

}  // namespace sinew
