#pragma once
/// Our own shapes for the four cases of Botsch and Sorkine, "On Linear Variational Surface Deformation Methods", TVCG
/// 2008, Figure 10: triangles, y up, about 1 m. All but the plane are closed and oriented outwards.

#include <array>

#include "apps/samples/implicit.h"

namespace sinew::samples {

/// 201 x 201 vertices over the square [0, 1] x [0, 1] of x and z, with 12 x 12 bumps: 40,401 vertices.
Shape bumpy_plane();
/// The same between its upper side and the plane y = -0.02, of `columns` x `rows` cells and as many below: a thin
/// solid.
Shape bumpy_slab(int columns, int rows);
/// A box of 20 x 66 x 20 cells along y, 0.5 x 1.65 x 0.5: 6,082 vertices.
Shape bar();
/// The faces of a box of so many cells of so much each along x, y and z, from y = 0, its middle at x = z = 0.
Shape box(const std::array<int, 3>& cells, const Vec3& cell);
/// A cylinder along y, radius 0.1, length 1.15, its ends rings around a centre: 4,802 vertices.
Shape cylinder();
/// With other numbers of vertices on a ring, of rings on each end, and of rings on the body.
Shape cylinder(Index around, Index cap_rings, Index body_rings);
/// A trunk with two arms, 1 high, from y = 0 to 0.985: about 5,000 vertices.
Shape cactus();
/// With cells of another size (see polygonized).
Shape cactus(double cell);

/// The zero set of `surface` as quads cut into triangles: one vertex for each cell (of size `cell`) that the surface
/// crosses, the mean of the crossings of its edges, joined around each crossed edge of the grid [Gibson, "Constrained
/// elastic surface nets", 1998], then evened out on the surface. Parts of the surface thinner than a cell may be lost.
Shape polygonized(const Implicit& surface, double cell);

}  // namespace sinew::samples
