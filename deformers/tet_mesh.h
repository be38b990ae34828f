#pragma once
/// A solid cut into tetrahedra, made from the closed surface of a shape: its faces decimated by quadrics to a wanted
/// size [Garland and Heckbert 1997], then filled by constrained Delaunay tets [Si, TetGen]
/// [Stoll, de Aguiar, Theobalt, Seidel 2007, sections 2.1 and 2.3.1].

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew {

/// T = (V_tet, T_tet). Coordinates are relative to the shape's origin, in its unit.
struct TetMesh {
  std::vector<Vec3> vertices;
  std::vector<Tet> tets;      ///< of positive volume, all of them
  std::vector<Index> points;  ///< the point of the shape that each of the first points.size() vertices is; the others
                              ///< were added inside

  /// Faces of exactly one tet, wound so that their normals point outwards, and the tet of each.
  struct Boundary {
    std::vector<std::array<Index, 3>> faces;
    std::vector<Index> tets;
  };
  Boundary boundary() const;
};

/// (p1 - p0) x (p2 - p0) . (p3 - p0) / 6.
double tet_volume(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3);

struct TetMeshOptions {
  int vertices = 5000;       ///< the surface is decimated to about so many; one that has fewer stays as it is
  bool inside = false;       ///< vertices inside are added for better tets
  int close_holes = 0;       ///< holes of up to so many edges are closed
  double max_seconds = 120;  ///< for the tets; the process that makes them is ended then
  std::size_t max_bytes = 4ull << 30;
};

/// Tets of a shape's faces. Points of no face are in no tet. `notes` gets a sentence for what was left out or changed
/// (points that lie on each other taken as one, faces without area), with its count. Throws InputError with a sentence
/// that names the faces or the holes where the faces bound no solid: none, open, not manifold, crossing themselves,
/// flat. Throws InputError, too, where making them took too long or too much memory. Null where progress said false.
///
/// Faces are numbered from 0, places are in the file's coordinates. Parts may lie in each other: what the faces wind
/// around is solid, so one that is wound against the one around it is a cavity. A surface that crosses itself when
/// decimated is tried with more vertices. TetGen runs in a process of its own, sinew-tets (deformers/tet_process.h).
std::optional<TetMesh> tetrahedralized(const Shape& shape, const TetMeshOptions& options,
                                       std::vector<std::string>& notes,
                                       const std::function<bool(double)>& progress = {});

/// The tets that a shape brings along (Shape::tets), in its order; vertices are its points that are in one. A tet that
/// is wound the other way is turned, one without volume is left out, both counted in `notes`. Throws InputError where
/// none is left or an index is beyond the points.
TetMesh tet_mesh_of(const Shape& shape, std::vector<std::string>& notes);

}  // namespace sinew
