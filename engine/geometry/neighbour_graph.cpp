#include "engine/geometry/neighbour_graph.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <unordered_map>

#include "engine/geometry/bounds.h"
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

namespace {

/// Halves the edges of triangles that are longer than `longest`.
class Halving {
 public:
  Halving(Surface& surface, double longest) : surface_(surface), longest_(longest) {}

  void add(const std::array<Index, 3>& triangle) {
    std::vector<std::array<Index, 3>> waiting{triangle};
    while (!waiting.empty()) {
      const auto [a, b, c] = turned(waiting.back());
      waiting.pop_back();
      if (length(a, b) > longest_) {
        const Index middle = middle_of(a, b);
        waiting.push_back({a, middle, c});
        waiting.push_back({middle, b, c});
        continue;
      }
      surface_.edges.emplace_back(a, b);
      surface_.edges.emplace_back(b, c);
      surface_.edges.emplace_back(c, a);
    }
  }

 private:
  double length(Index a, Index b) const { return (surface_.vertices[a] - surface_.vertices[b]).norm(); }

  /// With the longest edge first.
  std::array<Index, 3> turned(const std::array<Index, 3>& t) const {
    const double ab = length(t[0], t[1]), bc = length(t[1], t[2]), ca = length(t[2], t[0]);
    if (ab >= bc && ab >= ca) return t;
    return bc >= ca ? std::array{t[1], t[2], t[0]} : std::array{t[2], t[0], t[1]};
  }

  Index middle_of(Index a, Index b) {
    const auto [low, high] = std::minmax(a, b);
    const auto [entry, is_new] =
        middles_.try_emplace(std::uint64_t{low} << 32 | high, static_cast<Index>(surface_.vertices.size()));
    // The places first: the vector may move while it grows.
    const Vec3 middle = 0.5 * (surface_.vertices[low] + surface_.vertices[high]);
    if (is_new) surface_.vertices.push_back(middle);
    return entry->second;
  }

  Surface& surface_;
  double longest_;
  std::unordered_map<std::uint64_t, Index> middles_;
};

/// Of the corners of a face, finite and at different places.
double longest_pair(std::span<const Index> corners, const std::vector<Vec3>& vertices) {
  double longest = 0;
  for (std::size_t a = 0; a < corners.size(); ++a)
    for (std::size_t b = a + 1; b < corners.size(); ++b)
      longest = std::max(longest, (vertices[corners[a]] - vertices[corners[b]]).norm());
  return longest;
}

}  // namespace

Surface surface_of(const Shape& shape, const Places& places, double longest) {
  constexpr std::size_t all_pairs = 8;
  Surface surface{places.at, {}};
  Edges& edges = surface.edges;
  if (shape.faces.empty()) {
    join_near_points(places.at, [&](Index a, Index b) {
      if (a != b) edges.emplace_back(a, b);
    });
    return surface;
  }
  edges.reserve(shape.faces.points.size());
  Halving halving(surface, longest);
  std::vector<Index> corners;
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    corners.clear();
    for (const Index p : shape.faces[f])
      if (const Index v = places.of_point[p]; v != Places::none && (corners.empty() || corners.back() != v))
        corners.push_back(v);
    if (corners.size() <= all_pairs && longest_pair(corners, places.at) <= longest) {
      for (std::size_t a = 0; a < corners.size(); ++a)
        for (std::size_t b = a + 1; b < corners.size(); ++b)
          if (corners[a] != corners[b]) edges.emplace_back(corners[a], corners[b]);
      continue;
    }
    if (corners.size() == 2) halving.add({corners[0], corners[1], corners[1]});
    for (std::size_t c = 2; c < corners.size(); ++c) halving.add({corners[0], corners[c - 1], corners[c]});
  }
  std::erase_if(edges, [](const auto& e) { return e.first == e.second; });
  return surface;
}

bool has_longer_sides(const Shape& shape, double longest) {
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    const auto corners = shape.faces[f];
    for (std::size_t c = 0; c < corners.size(); ++c)
      if ((shape.positions[corners[c]] - shape.positions[corners[(c + 1) % corners.size()]]).norm() > longest)
        return true;
  }
  return false;
}

double edge_length_for(const Shape& shape, double wanted, std::size_t vertices) {
  double area = 0;
  const std::vector<Index> triangles = triangles_of(shape.faces);
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const Vec3& a = shape.positions[triangles[t]];
    const double twice = (shape.positions[triangles[t + 1]] - a).cross(shape.positions[triangles[t + 2]] - a).norm();
    if (std::isfinite(twice)) area += 0.5 * twice;
  }
  // Long thin triangles have next to no area: a thousandth of the diagonal is fine enough for any.
  return std::max(
      {wanted, std::sqrt(area / (16 * static_cast<double>(vertices))), 1e-3 * bounds_of(shape.positions).diagonal()});
}

NeighbourGraph neighbour_graph(std::vector<Vec3> vertices, const Edges& edges) {
  NeighbourGraph graph;
  graph.vertices = std::move(vertices);
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
