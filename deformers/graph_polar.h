#pragma once
/// The minimum of the paper's energy (graph_energy.h, 12 unknowns a node) with no more than the factor of the rigid
/// Hessian (6 unknowns a node: a fifth of the time to make, a third to use).
///
///   R_j = Q_j U_j, Q_j a rotation, U_j symmetric:  Q_j <- Q_j exp(omega_j), U_j <- U_j + S_j, t_j <- t_j + Q_j tau_j
///
/// omega and tau are the unknowns of the rigid steps; S is the strain, which E_rot alone nearly determines: at the
/// paper's weights its curvature, 4 w_rot, is some thirty times that of the other terms. So the rigid factor for
/// (omega, tau) and a diagonal for S are near J'J, and limited-memory BFGS around them converges in few steps. Where
/// w_rot is small they are not near, and the caller must see to it (status MaxIterations).

#include "deformers/gauss_newton.h"
#include "deformers/graph_energy.h"

namespace sinew {

/// How the surroundings of each free node turned from `before` to `after`: the rotations that take its edges there as
/// nearly as rotations can.
std::vector<Mat3> turns_between(std::span<const Vec3> before, std::span<const Vec3> after,
                                std::span<const std::pair<Index, Index>> edges, std::span<const Index> free_nodes);

/// Minimises from x. `rigid` has the pattern for 6 unknowns a node, analysed.
GaussNewtonResult minimise_polar(const GraphEnergy& energy, GraphState& x, KeptFactor& rigid,
                                 const GaussNewtonOptions& options);

}  // namespace sinew
