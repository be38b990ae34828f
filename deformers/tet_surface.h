#pragma once
/// The closed surface that tets are made of: a shape's faces as triangles that share their points, checked and, where
/// that can be done without a guess, mended.

#include <string>
#include <vector>

#include "deformers/tet_process.h"
#include "engine/geometry/shape.h"

namespace sinew {

struct TetSurface {
  std::vector<Vec3> vertices;       ///< relative to the shape's origin; each is a corner of a triangle, all differ
  std::vector<Index> points;        ///< of the shape, for each vertex
  std::vector<Triangle> triangles;  ///< every edge is in two, which run through it in opposite directions
  std::vector<Index> faces;         ///< of the shape, for each triangle; no_face where it closes a hole
  static constexpr Index no_face = ~Index{0};
};

/// Throws InputError with a sentence that names the faces, edges or holes where there is no such surface. `notes` gets
/// a sentence with a count for each kind of change: points in the same place taken as one, faces without area or given
/// twice left out, faces turned, holes of up to `close_holes` edges closed.
TetSurface closed_surface(const Shape& shape, int close_holes, std::vector<std::string>& notes);

/// The volume that the triangles enclose, each part as often as they wind around it; negative where they are wound
/// inwards. Relative to the vertices' middle, so that an offset takes nothing of its precision.
double enclosed_volume(const TetSurface& surface);

/// How often the triangles wind around a point that is not on them, outwards counting as positive [Jacobson, Kavan,
/// Sorkine 2013, eq. 5 and 6: the sum of their solid angles over 4 pi].
int winding_number(const TetSurface& surface, const Vec3& point);

/// "1 face", "2 faces".
std::string counted(std::size_t count, const char* one, const char* more);

/// Six digits.
std::string number_text(double value);

/// "(x, y, z)" in the file's coordinates.
std::string place_text(const Shape& shape, const Vec3& position);

/// "3, 17, 20 and 5 more": at most `most` of the numbers.
std::string list_text(const std::vector<Index>& numbers, std::size_t most = 5);

/// "7 faces: 3, 17, 20, 21, 22 and 2 more": those that the triangles are of, and "what closes holes" where one closes
/// one.
std::string faces_text(const TetSurface& surface, const std::vector<Index>& triangles);

}  // namespace sinew
