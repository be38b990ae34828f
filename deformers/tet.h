#pragma once
/// The tetrahedral Laplacian editor [Stoll, de Aguiar, Theobalt, Seidel: A Volumetric Approach to Interactive Shape
/// Editing, MPI-I-2007-4-004, 2007] as a Deformer: bends solids, the surface of which is closed, and keeps their volume
/// nearly.
///
/// Made of the tets that the edit or the shape brings along, else of the surface (tet_mesh.h). A map of the pose is a
/// tet's. Where every point of the surface is a vertex of a tet it follows one tet exactly; else all points follow the
/// tets near them (tet_transfer.h).
///
/// Held exactly: vertices of tets that are points of a handle or fixed. A handle between vertices, or of places inside
/// the solid, is a combination of them and held by a stiff spring; a place outside is a vertex of its own, joined to
/// the nearest boundary faces by tets that are not seen [section 3.2].

#include <memory>

#include "deformers/tet_mesh.h"
#include "engine/geometry/deformer.h"

namespace sinew {

struct TetOptions {
  TetMeshOptions mesh;
  bool interpolate_rotations = true;   ///< section 2.3.2, rotation interpolation
  std::shared_ptr<const Shape> solid;  ///< tets to use, relative to the shape's origin; null: the shape's own, or made
};

/// Throws InputError where the shape bounds no solid. Null where progress said false.
std::unique_ptr<Deformer> make_tet_deformer(std::shared_ptr<const Shape> rest, const TetOptions& options,
                                            const std::function<bool(double)>& progress = {});

/// The row of the methods table.
Method tet_method();

}  // namespace sinew
