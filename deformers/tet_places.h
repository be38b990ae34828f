#pragma once
/// Where points are in a solid: in which tet, or outside near which boundary faces.

#include <optional>
#include <span>
#include <vector>

#include "deformers/tet_mesh.h"
#include "deformers/tet_solver.h"
#include "engine/geometry/nearest.h"

namespace sinew {

class TetPlaces {
 public:
  explicit TetPlaces(const TetMesh& mesh);

  /// The tet that `p` is in, or the one behind the nearest boundary face: the combination of its corners that is `p`
  /// (weights below 0 where p is outside).
  TetTie tie(const Vec3& p) const;
  /// Whether p is outside of the solid by more than `tolerance`.
  bool outside(const Vec3& p, double tolerance) const;
  /// Boundary faces that look at p, nearest centre first, at most `count`.
  std::vector<std::array<Index, 3>> faces_before(const Vec3& p, std::size_t count) const;

 private:
  std::optional<TetTie> within(Index tet, const Vec3& p) const;
  std::optional<TetTie> inside(const Vec3& p) const;

  const TetMesh& mesh_;
  TetMesh::Boundary boundary_;
  NearestTree faces_;  ///< centres of boundary faces
};

}  // namespace sinew
