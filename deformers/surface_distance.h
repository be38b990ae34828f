#pragma once
/// The nodes that are nearest to each point along the surface, for the weights of eq. 4 where straight distance would
/// join what only lies side by side [Sumner et al. 2007, section 6].

#include <functional>
#include <span>
#include <vector>

#include "engine/geometry/curtains.h"
#include "engine/geometry/neighbour_graph.h"

namespace sinew {

/// Rows of up to `width` nodes with their distances, in order of (distance, node); the rest of a row is `none`.
struct NearestNodes {
  static constexpr Index none = ~Index{0};
  std::size_t width = 0;
  std::vector<Index> node;
  std::vector<double> distance;
};

/// How long edges may be (surface_of) where a shape is to be no coarser than the graph of its nodes: 3/4 of the median
/// distance between these, but not so short that more points than some 16 a node and point were added.
double surface_edge_length(const Shape& shape, std::span<const Vec3> nodes);

/// What points are joined along: the edges of surface_of with surface_edge_length, bridges across gaps (part_gaps.h:
/// within the spacing of the nodes, or any gap where a part has fewer than `enough` of them), less all that crosses a
/// curtain. A part is what the surface's edges join, curtains or not: no bridge goes around a curtain that cuts through
/// one part.
NeighbourGraph surface_graph(const Shape& shape, const Places& places, std::span<const Vec3> nodes, int enough,
                             const Curtains& curtains);

/// The `width` nearest nodes of each vertex of the graph, in one sweep from all nodes at once, in order of distance
/// [Dijkstra 1959]; each vertex is settled at most `width` times: O(n width log n). A node starts from its nearest
/// vertex and that one's neighbours.
///
/// Where two neighbours p, q of a vertex r that are neighbours themselves know their distances a, b to a node, the
/// triangle is laid into the plane, the node's image is the point at a from p and b from q on the side away from r, and
/// if the line from it to r passes between p and q, its length is r's distance [after Novotni and Klein: Computing
/// geodesic distances on triangular meshes, 2002]; else it is the way through p or through q. On flat parts the
/// distances are therefore nearly the straight ones, not those of zigzags along edges.
///
/// The result is empty where progress (0..1) said false. Serial: threads do not change a bit.
NearestNodes nearest_along_surface(const NeighbourGraph& graph, std::span<const Vec3> nodes, int width,
                                   const Curtains& curtains, const std::function<bool(double)>& progress = {});

}  // namespace sinew
