#pragma once
/// Solids made of cubes, each cut into six tets around its diagonal [Kuhn 1960].

#include <vector>

#include "engine/geometry/shape.h"

namespace sinew::test {

struct Solid {
  std::vector<Vec3> vertices;
  std::vector<Tet> tets;
};

/// nx x ny x nz cubes of side `cell` from the origin; vertex (i, j, k) is number (k (ny + 1) + j) (nx + 1) + i.
inline Solid box(Index nx, Index ny, Index nz, double cell) {
  Solid out;
  const auto at = [&](Index i, Index j, Index k) { return (k * (ny + 1) + j) * (nx + 1) + i; };
  for (Index k = 0; k <= nz; ++k)
    for (Index j = 0; j <= ny; ++j)
      for (Index i = 0; i <= nx; ++i) out.vertices.push_back(cell * Vec3(i, j, k));
  constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (Index k = 0; k < nz; ++k)
    for (Index j = 0; j < ny; ++j)
      for (Index i = 0; i < nx; ++i)
        for (int o = 0; o < 6; ++o) {
          Index corner[3] = {i, j, k};
          Tet tet{at(i, j, k)};
          for (int step = 0; step < 3; ++step) {
            ++corner[orders[o][step]];
            tet[static_cast<std::size_t>(step) + 1] = at(corner[0], corner[1], corner[2]);
          }
          if (o >= 3) std::swap(tet[2], tet[3]);  // odd orders are wound the other way
          out.tets.push_back(tet);
        }
  return out;
}

/// The box as a shape: 1 unit long at most, so that its diagonal is near 1.
inline Shape shape_of(const Solid& solid) {
  Shape out;
  out.positions = solid.vertices;
  out.tets = solid.tets;
  return out;
}

inline double volume_of(const std::vector<Vec3>& x, const std::vector<Tet>& tets) {
  double sum = 0;
  for (const Tet& t : tets) sum += (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).dot(x[t[3]] - x[t[0]]) / 6;
  return sum;
}

}  // namespace sinew::test
