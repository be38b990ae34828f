#pragma once
/// Triangles that tests of surfaces share.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "engine/geometry/random.h"
#include "engine/geometry/shape.h"

namespace sinew::test {

struct Mesh {
  std::vector<Vec3> positions;
  std::vector<std::array<Index, 3>> triangles;
};

/// columns x rows points in a grid, each quad cut in two; closed around where `around` says so.
inline std::vector<std::array<Index, 3>> grid_triangles(Index columns, Index rows, bool around) {
  std::vector<std::array<Index, 3>> out;
  const auto at = [&](Index i, Index j) { return i % columns * rows + j % rows; };
  for (Index i = 0; i + (around ? 0 : 1) < columns; ++i)
    for (Index j = 0; j + (around ? 0 : 1) < rows; ++j) {
      out.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      out.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return out;
}

/// A torus of radii 1 and 0.35 with bumps; `bend` moves it.
inline Mesh bumpy_torus(Index columns, Index rows, double bend = 0) {
  Mesh mesh;
  for (Index i = 0; i < columns; ++i)
    for (Index j = 0; j < rows; ++j) {
      const double u = 2 * std::numbers::pi * i / columns, v = 2 * std::numbers::pi * j / rows;
      const double r = 0.35 + 0.03 * std::sin(5 * u) * std::sin(3 * v);
      mesh.positions.emplace_back((1 + r * std::cos(v)) * std::cos(u), (1 + r * std::cos(v)) * std::sin(u),
                                  r * std::sin(v) + bend * std::cos(2 * u));
    }
  mesh.triangles = grid_triangles(columns, rows, true);
  return mesh;
}

/// A flat square sheet of side 1 with its points shaken within it, at height z; `bend` bows it.
inline Mesh sheet(Index side, double bend = 0, double z = 0) {
  Mesh mesh;
  for (Index i = 0; i < side; ++i)
    for (Index j = 0; j < side; ++j) {
      const bool inside = i > 0 && j > 0 && i + 1 < side && j + 1 < side;
      const double shake = inside ? 0.5 : 0;
      const double x = (i + shake * (random_unit(1, i * side + j) - 0.5)) / (side - 1);
      const double y = (j + shake * (random_unit(2, i * side + j) - 0.5)) / (side - 1);
      mesh.positions.emplace_back(x, y, z + bend * std::sin(3 * x));
    }
  mesh.triangles = grid_triangles(side, side, false);
  return mesh;
}

inline Mesh both(Mesh a, const Mesh& b) {
  const auto first = static_cast<Index>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const auto& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

/// How many triangles each edge (low, high) has.
inline std::map<std::pair<Index, Index>, int> edge_counts(const std::vector<std::array<Index, 3>>& triangles) {
  std::map<std::pair<Index, Index>, int> edges;
  for (const auto& t : triangles)
    for (std::size_t c = 0; c < 3; ++c) ++edges[std::minmax({t[c], t[(c + 1) % 3]})];
  return edges;
}

}  // namespace sinew::test
