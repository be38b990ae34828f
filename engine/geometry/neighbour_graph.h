#pragma once
/// A neighbour graph of a shape's points, along which distances are measured on its surface: of meshes, soups and
/// scans alike.

#include <span>
#include <utility>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew {

/// Undirected, over m vertices; a row lists the neighbours of a vertex, ascending (CSR).
struct NeighbourGraph {
  std::vector<Vec3> vertices;
  std::vector<std::uint64_t> offsets{0};
  std::vector<Index> neighbours;

  std::size_t size() const { return vertices.size(); }
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

/// What the surface joins: corners of a face with each other; of a face with more than 8 corners, or with a side or
/// diagonal longer than `longest`, those of its triangles, whose edges are halved (the longest first, the same way from
/// both sides) until none is longer: a large face then has points inside. In a shape without faces, near points
/// (join_near_points). Vertices are the places, and behind them the points that were added. Doubles may be among the
/// edges.
struct Surface {
  std::vector<Vec3> vertices;
  Edges edges;
};
Surface surface_of(const Shape& shape, const Places& places, double longest);

/// A length for surface_of such that it adds no more than some 16 `vertices` points, nor any where faces are smaller
/// than `wanted`.
double edge_length_for(const Shape& shape, double wanted, std::size_t vertices);

/// Whether surface_of would add points.
bool has_longer_sides(const Shape& shape, double longest);

/// The graph of these edges, in any order and direction, doubles allowed.
NeighbourGraph neighbour_graph(std::vector<Vec3> vertices, const Edges& edges);

/// The connected part that each vertex belongs to, numbered by the lowest vertex of each, and their count.
struct GraphParts {
  std::vector<Index> of_vertex;
  std::size_t count = 0;
};
GraphParts parts_of(std::size_t vertices, const Edges& edges);

}  // namespace sinew
