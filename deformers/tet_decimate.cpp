#include "deformers/tet_decimate.h"

#include <algorithm>

#include "deformers/decimate.h"
#include "deformers/tet_surface_edges.h"
#include "engine/geometry/union_find.h"

namespace sinew {

namespace {

/// Corners of triangles, 3 each, that meet around a vertex across edges have the same number: parts of the surface that
/// touch in a vertex alone are apart, because a mesh of half-edges can't hold them otherwise.
struct Split {
  std::vector<Triangle> triangles;
  std::vector<Index> vertex_of;  ///< of each number
};

Split split_vertices(const TetSurface& surface) {
  const std::vector<Index> opposite = opposite_edges(surface);
  const auto next = [](Index corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
  UnionFind same(opposite.size());
  for (Index edge = 0; edge < opposite.size(); ++edge) {  // it runs from corner `edge`; its opposite the other way
    same.join(edge, next(opposite[edge]));
    same.join(next(edge), opposite[edge]);
  }
  Split split;
  std::vector<Index> number(opposite.size(), TetSurface::no_face);
  for (Index t = 0; t < surface.triangles.size(); ++t) {
    Triangle corners{};
    for (Index k = 0; k < 3; ++k) {
      Index& n = number[same.root(3 * t + k)];
      if (n == TetSurface::no_face) {
        n = static_cast<Index>(split.vertex_of.size());
        split.vertex_of.push_back(surface.triangles[t][k]);
      }
      corners[k] = n;
    }
    split.triangles.push_back(corners);
  }
  return split;
}

}  // namespace

TetSurface decimated_surface(const TetSurface& surface, std::size_t count, const std::function<bool()>& go_on) {
  const Split split = split_vertices(surface);
  std::vector<Vec3> places;
  for (const Index v : split.vertex_of) places.push_back(surface.vertices[v]);
  const Decimated coarse = decimated(places, split.triangles, count, true, go_on);
  std::vector<Index> number(surface.vertices.size(), 0);
  for (const Triangle& t : coarse.triangles)
    for (const Index corner : t) number[split.vertex_of[corner]] = 1;
  TetSurface result;
  for (Index v = 0; v < number.size(); ++v) {
    if (number[v] == 0) continue;
    number[v] = static_cast<Index>(result.vertices.size());
    result.vertices.push_back(surface.vertices[v]);
    result.points.push_back(surface.points[v]);
  }
  for (std::size_t t = 0; t < coarse.triangles.size(); ++t) {
    const auto [a, b, c] = coarse.triangles[t];
    result.triangles.push_back({number[split.vertex_of[a]], number[split.vertex_of[b]], number[split.vertex_of[c]]});
    result.faces.push_back(surface.faces[coarse.origins[t]]);
  }
  return result;
}

}  // namespace sinew
