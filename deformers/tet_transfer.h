#pragma once
/// The pose of a fine surface from that of a coarse solid [Stoll, de Aguiar, Theobalt, Seidel 2007, section 2.4].
///
///   p' = sum_j w_j(p) T_j p,   w_j = phi_j / sum phi,   phi_j = (1 - d/r)^4 (4 d/r + 1),  d = |p - centre_j| <= r
///
/// (eq. 2.9-2.11) over the boundary faces j with centres within r, T_j the map of the tet behind the face: barycentric
/// coordinates with respect to that tet, blended. So it is linear blend skinning by the maps of tets, exact where all
/// of them agree. A tet with several faces nearby has the sum of their weights.

#include <functional>
#include <span>
#include <vector>

#include "deformers/tet_mesh.h"
#include "engine/geometry/skin_weights.h"

namespace sinew {

struct TetFaces {
  std::vector<Vec3> centres;  ///< of the boundary faces
  std::vector<Index> tets;    ///< behind them
  double radius = 0;          ///< r

  static constexpr double part = 0.05;  ///< r in units of the bounding box's diagonal, as in the report
};

TetFaces faces_of(const TetMesh& mesh);

/// Rows for any points; a point that is not finite has an empty one. Where r holds no centre, it is widened for that
/// point to twice the distance of the nearest; `widened` counts these. Fewer rows than points where progress said
/// false.
SkinWeights transfer_weights(const TetFaces& faces, std::span<const Vec3> points, Gradients gradients,
                             std::size_t* widened = nullptr, const std::function<bool(double)>& progress = {});

}  // namespace sinew
