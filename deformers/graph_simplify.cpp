#include "deformers/decimate.h"
#include "deformers/graph_nodes.h"
#include "engine/geometry/topology.h"

namespace sinew {

std::vector<Vec3> simplify_to_nodes(const Shape& shape, std::size_t count, std::string& note) {
  std::vector<std::array<Index, 3>> triangles;
  const std::vector<Index> corners = triangles_of(shape.faces);
  for (std::size_t t = 0; t < corners.size(); t += 3) {
    const Index a = corners[t], b = corners[t + 1], c = corners[t + 2];
    if (a != b && b != c && c != a && shape.positions[a].allFinite() && shape.positions[b].allFinite() &&
        shape.positions[c].allFinite())
      triangles.push_back({a, b, c});
  }
  const Decimated coarse = decimated(shape.positions, triangles, count, false);
  if (const std::size_t refused = corners.size() / 3 - triangles.size() + coarse.refused; refused > 0)
    note = std::to_string(refused) + " faces that are degenerate or not manifold were left out of the simplification";
  std::vector<Vec3> nodes;
  for (const Index i : coarse.vertices) nodes.push_back(shape.positions[i]);
  return nodes;
}

}  // namespace sinew
