#pragma once
/// A neighbour graph of a shape's points, along which distances are measured on its surface: of meshes, soups and
/// scans alike.

#include <span>
#include <utility>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew {

/// Undirected, over m vertices at different places; a row lists the neighbours of a vertex, ascending (CSR).
struct NeighbourGraph {
  std::vector<Vec3> places;
  std::vector<std::uint64_t> offsets{0};
  std::vector<Index> neighbours;

  std::size_t size() const { return places.size(); }
  std::span<const Index> operator[](Index v) const {
    return {neighbours.data() + offsets[v], neighbours.data() + offsets[v + 1]};
  }
};

/// The places of a shape's finite points: points at the very same coordinates (an unwelded seam, the corners of a
/// soup) share one, so that a soup has the distances of the mesh it would be if welded.
struct Places {
  static constexpr Index none = ~Index{0};
  std::vector<Index> of_point;  ///< n; of a point that is not finite: none
  std::vector<Vec3> at;         ///< in the order of their lowest points
};
Places places_of(std::span<const Vec3> positions);

using Edges = std::vector<std::pair<Index, Index>>;

/// Pairs of places that the surface joins: corners of a face (of one with more than 8 only neighbours, and each with
/// the first); in a shape without faces, near points (join_near_points). Doubles may be among them.
Edges surface_edges(const Shape& shape, const Places& places);

/// The graph of these edges, in any order and direction, doubles allowed.
NeighbourGraph neighbour_graph(std::vector<Vec3> places, const Edges& edges);

/// The connected part that each vertex belongs to, numbered by the lowest vertex of each, and their count.
struct GraphParts {
  std::vector<Index> of_vertex;
  std::size_t count = 0;
};
GraphParts parts_of(std::size_t vertices, const Edges& edges);

}  // namespace sinew
