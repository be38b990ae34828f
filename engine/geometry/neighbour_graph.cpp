#include "engine/geometry/neighbour_graph.h"

#include <algorithm>
#include <tuple>

#include "engine/geometry/topology.h"
#include "engine/geometry/union_find.h"

namespace sinew {

Places places_of(std::span<const Vec3> positions) {
  std::vector<Index> order;
  order.reserve(positions.size());
  for (Index i = 0; i < positions.size(); ++i)
    if (positions[i].allFinite()) order.push_back(i);
  const auto key = [&](Index i) {
    const Vec3& p = positions[i];
    return std::tuple(p.x(), p.y(), p.z());
  };
  std::sort(order.begin(), order.end(),
            [&](Index a, Index b) { return std::tuple(key(a), a) < std::tuple(key(b), b); });

  // Until all are known, a point's entry is the lowest point of its place.
  Places places;
  places.of_point.assign(positions.size(), Places::none);
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool same = k > 0 && key(order[k]) == key(order[k - 1]);
    places.of_point[order[k]] = same ? places.of_point[order[k - 1]] : order[k];
  }
  for (Index i = 0; i < positions.size(); ++i) {
    Index& place = places.of_point[i];
    if (place == Places::none) continue;
    if (place == i) {
      place = static_cast<Index>(places.at.size());
      places.at.push_back(positions[i]);
    } else {
      place = places.of_point[place];  // a lower point, numbered already
    }
  }
  return places;
}

Edges surface_edges(const Shape& shape, const Places& places) {
  constexpr std::size_t all_pairs = 8;
  Edges edges;
  const auto join = [&](Index a, Index b) {
    if (a != b && a != Places::none && b != Places::none) edges.emplace_back(std::min(a, b), std::max(a, b));
  };
  if (shape.faces.empty()) {
    join_near_points(places.at, join);
    return edges;
  }
  edges.reserve(shape.faces.points.size());
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    const auto corners = shape.faces[f];
    for (std::size_t a = 0; a < corners.size(); ++a) {
      const std::size_t last = corners.size() <= all_pairs || a == 0 ? corners.size() : std::min(a + 2, corners.size());
      for (std::size_t b = a + 1; b < last; ++b) join(places.of_point[corners[a]], places.of_point[corners[b]]);
    }
  }
  return edges;
}

NeighbourGraph neighbour_graph(std::vector<Vec3> places, const Edges& edges) {
  NeighbourGraph graph;
  graph.places = std::move(places);
  const std::size_t n = graph.size();
  std::vector<std::uint64_t> begin(n + 1, 0);
  for (const auto& [a, b] : edges) {
    ++begin[a + 1];
    ++begin[b + 1];
  }
  for (std::size_t v = 0; v < n; ++v) begin[v + 1] += begin[v];
  std::vector<Index> both(2 * edges.size());
  std::vector<std::uint64_t> next(begin.begin(), begin.end() - 1);
  for (const auto& [a, b] : edges) {
    both[next[a]++] = b;
    both[next[b]++] = a;
  }
  graph.offsets.reserve(n + 1);
  for (std::size_t v = 0; v < n; ++v) {
    const auto first = both.begin() + static_cast<std::ptrdiff_t>(begin[v]);
    const auto last = both.begin() + static_cast<std::ptrdiff_t>(begin[v + 1]);
    std::sort(first, last);
    graph.neighbours.insert(graph.neighbours.end(), first, std::unique(first, last));
    graph.offsets.push_back(graph.neighbours.size());
  }
  return graph;
}

GraphParts parts_of(std::size_t vertices, const Edges& edges) {
  UnionFind sets(vertices);
  for (const auto& [a, b] : edges) sets.join(a, b);
  GraphParts parts;
  parts.of_vertex.resize(vertices);
  for (Index v = 0; v < vertices; ++v) {
    const Index root = sets.root(v);  // the lowest of its set
    parts.of_vertex[v] = root == v ? static_cast<Index>(parts.count++) : parts.of_vertex[root];
  }
  return parts;
}

}  // namespace sinew
