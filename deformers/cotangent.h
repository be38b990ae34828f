#pragma once
/// The Laplacian of a triangle mesh [Pinkall and Polthier 1993; Botsch, Kobbelt, Pauly, Alliez and Levy, "Polygon Mesh
/// Processing", 2010, section 3.3.4].
///
///   L_ij = -w_ij = -(cot a_ij + cot b_ij)/2, L_ii = sum_j w_ij: positive semidefinite, x'Lx = integral of |grad x|^2
///   M_ii  a third of the area of i's triangles (squared length)
///   grad  of a triangle's linear function; div = grad' weighted by areas: div grad = L
///
/// Triangles that are degenerate get longer edges until each is at least 1/100 of the mean edge shorter than the other
/// two together [Sharp and Crane, "A Laplacian for Nonmanifold Triangle Meshes", 2020, a triangle at a
/// time]; so any triangles have weights, L is positive semidefinite, and M > 0 where there are triangles.

#include <array>
#include <span>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew {

struct CotangentLaplacian {
  std::vector<std::array<Index, 3>> triangles;  ///< those with three different corners
  std::vector<std::array<double, 3>> cot;       ///< of each, half the cotangent at each corner
  std::vector<double> area;                     ///< of each
  std::vector<double> M;                        ///< of each vertex; 0 without triangles; at least 1/100 of the mean
  /// Row i: neighbours to[offsets[i]] .. to[offsets[i+1]-1], ascending, with w_ij.
  std::vector<Index> offsets{0}, to;
  std::vector<double> w;
  /// The corners at vertex i: 3 t + c, ascending, at corner_offsets[i] ..
  std::vector<Index> corner_offsets{0}, corners;

  std::size_t size() const { return M.size(); }
};

/// Positions: finite where triangles are.
CotangentLaplacian cotangent_laplacian(std::span<const Vec3> positions,
                                       const std::vector<std::array<Index, 3>>& triangles);

/// L x.
std::vector<Vec3> multiply(const CotangentLaplacian& L, std::span<const Vec3> x);

/// div(S grad x): with one linear map for each of L's triangles. With all S = identity it is L x; the least squares of
/// |grad y - S grad x|^2 over the area solves L y = div(S grad x) [Sumner and Popovic 2004; Botsch, Sumner, Pauly and
/// Gross 2006].
std::vector<Vec3> divergence(const CotangentLaplacian& L, std::span<const Mat3> S, std::span<const Vec3> x);

}  // namespace sinew
