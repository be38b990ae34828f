#pragma once
/// An edit's constraints on the points of a shape, as constraints on the vertices of its solid.

#include <optional>

#include "deformers/tet_places.h"

namespace sinew {

/// How the vertices of a solid and the points of its shape belong together.
struct TetBinding {
  std::vector<Index> vertex_of_point;  ///< none where the point is not a vertex
  std::vector<Index> point_of_vertex;  ///< the point that a vertex is, else the nearest one
  static constexpr Index none = ~Index{0};
};

TetBinding bind_vertices(const TetMesh& mesh, const Shape& rest);

/// Constraints of the solver, and the vertices and tets that they add to the solid: those of places outside.
struct TetPlan {
  TetConstraints constraints;          ///< handles in order; then, if need be, one for what is fixed between vertices
  std::vector<Vec3> extra_vertices;    ///< after the mesh's own
  std::vector<Tet> extra_tets;         ///< not seen
  std::vector<std::vector<Index>> at;  ///< of each handle: which of its targets each vertex, then each tie, has
  std::vector<Vec3> fixed_targets;     ///< of the handle for what is fixed between vertices
  std::size_t loose_places = 0;        ///< places outside that no boundary face looks at: tied as if inside
};

/// `finite` says which points can be held at all. Handles without a vertex of the solid are tied at their points.
TetPlan plan_constraints(const Constraints& constraints, const TetMesh& mesh, const TetBinding& binding,
                         const Shape& rest);

}  // namespace sinew
