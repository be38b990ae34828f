#pragma once
/// Decimation of triangles by quadrics [Garland and Heckbert, "Surface Simplification Using Quadric Error Metrics",
/// 1997], by collapses of an edge to one of its ends: the vertices that remain are vertices of before, in their places.

#include <array>
#include <functional>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew {

struct Decimated {
  std::vector<Index> vertices;                  ///< those that remain, in no certain order; isolated ones are left out
  std::vector<std::array<Index, 3>> triangles;  ///< over all vertices, as they were given
  std::vector<Index> origins;                   ///< for each triangle, which one it was
  std::size_t refused = 0;                      ///< triangles left out before: they would make the mesh not manifold
};

/// To about `count` vertices, without long, thin triangles where that is possible: the limit of the aspect ratio is
/// loosened until the count is reached. With `keep_normals` no collapse turns a triangle by more than 60 degrees, and
/// the count may not be reached. Each triangle has three different corners with finite positions. Stops early where
/// `go_on`, called now and then, says false.
Decimated decimated(const std::vector<Vec3>& positions, const std::vector<std::array<Index, 3>>& triangles,
                    std::size_t count, bool keep_normals, const std::function<bool()>& go_on = {});

}  // namespace sinew
