#pragma once
/// Connected components and edges of a shape.

#include <utility>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew {

/// component[i] of each point, numbered by the lowest point of each, and their count. Points are joined by faces; in a
/// shape without faces, to each of their 8 nearest points that is nearer than 4 times the median distance between
/// neighbours (so an outlier or an island of a scan is a component). Points that are not finite are components of their
/// own, counted apart: component[i] == none.
struct Components {
  static constexpr Index none = ~Index{0};
  std::vector<Index> of_point;
  std::size_t count = 0;
};
Components connected_components(const Shape& shape);

/// That definition for points without faces: calls join(i, j) for each pair of points that are joined, at least once.
void join_near_points(std::span<const Vec3> positions, const std::function<void(Index, Index)>& join);

/// Each undirected edge of the faces once, (low, high), ascending.
std::vector<std::pair<Index, Index>> edges_of(const Faces& faces);

/// Every face as a fan of triangles, 3 indices each. A face of fewer than three corners gives none.
std::vector<Index> triangles_of(const Faces& faces);

/// Vertex normals from the faces, weighted by area; zero where a point has none. n of them.
std::vector<Vec3> vertex_normals(const Shape& shape);

/// Edge length figures [interface.md, quality]: rms = sqrt(mean((l'/l - 1)^2)), max = max |l'/l - 1| over edges with l
/// > 0, and the relative change of the enclosed volume, for closed consistently oriented faces only.
struct Quality {
  bool has_edges = false, closed = false;
  double edge_rms = 0, edge_max = 0, volume_change = 0;
};
Quality quality_of(const Shape& rest, std::span<const Vec3> bent);

/// In what `other` does not correspond to `shape`, as the rest of a sentence: the first face with other corners,
/// another number of points or faces, a point that is not finite where the shape's is. Empty where it corresponds.
std::string difference_of_faces(const Shape& shape, const Shape& other);

}  // namespace sinew
