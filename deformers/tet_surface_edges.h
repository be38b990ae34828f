#pragma once
/// What the edges of a surface tell: whether it is closed, where its holes are, which way its triangles turn.

#include "deformers/tet_surface.h"

namespace sinew {

/// Throws InputError where an edge is in more than two triangles.
void check_edges(const Shape& shape, const TetSurface& surface);

/// Closes holes of up to `longest` edges by triangles between their vertices; returns how many. Throws InputError where
/// longer ones are left, with their count, the largest and its place.
std::size_t close_holes_of(const Shape& shape, int longest, TetSurface& surface);

/// Turns triangles so that each part of the surface runs through its edges in opposite directions, the fewer ones of
/// each part; returns how many. Throws InputError where that cannot be (a one-sided surface).
std::size_t turn_faces(const Shape& shape, TetSurface& surface);

/// The edge opposite to each edge of a surface whose edges are in two triangles each. Edge 3 t + k runs from corner k
/// of triangle t to the next.
std::vector<Index> opposite_edges(const TetSurface& surface);

/// Whether every edge is in two triangles that run through it in opposite directions.
bool is_closed(const TetSurface& surface);

/// A triangle without area whose corners are in different places lies on an edge: that edge is cut at the corner
/// between and the triangle given up, which keeps the surface closed. Returns how many; throws InputError where it
/// cannot be.
std::size_t join_flat_triangles(TetSurface& surface);

}  // namespace sinew
