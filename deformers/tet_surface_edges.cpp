#include "deformers/tet_surface_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <set>

#include "deformers/polygon_ears.h"
#include "engine/geometry/error.h"

namespace sinew {

namespace {

struct Edge {
  Index low, high, triangle;
  bool rises;  ///< the triangle runs from low to high

  auto ends() const { return std::pair(low, high); }
};

/// Three for each triangle, those of the same ends together.
std::vector<Edge> sorted_edges(const TetSurface& surface) {
  std::vector<Edge> edges;
  edges.reserve(3 * surface.triangles.size());
  for (Index t = 0; t < surface.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const Index a = surface.triangles[t][k], b = surface.triangles[t][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, a < b});
    }
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tuple(a.low, a.high, a.triangle) < std::tuple(b.low, b.high, b.triangle);
  });
  return edges;
}

/// Calls body with each run of edges that have the same ends.
template <class Body>
void for_each_edge(const std::vector<Edge>& edges, const Body& body) {
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].ends() == edges[begin].ends()) ++end;
    body(std::span<const Edge>(edges.data() + begin, end - begin));
  }
}

using Loop = std::vector<Index>;  ///< vertices, so that triangles wound as it fit the surface

/// Loops of edges that are in one triangle only.
std::vector<Loop> holes_of(const TetSurface& surface) {
  // The hole's side of an edge runs against its triangle. Several leave a vertex where holes touch or triangles
  // disagree.
  std::multimap<Index, Index> next, back;
  for_each_edge(sorted_edges(surface), [&](std::span<const Edge> same) {
    if (same.size() != 1) return;
    const Edge& edge = same[0];
    const auto [from, to] = edge.rises ? std::pair(edge.high, edge.low) : std::pair(edge.low, edge.high);
    next.emplace(from, to);
    back.emplace(to, from);
  });
  const auto take = [](std::multimap<Index, Index>& map, Index from, Index to) {
    for (auto [i, end] = map.equal_range(from); i != end; ++i)
      if (i->second == to) {
        map.erase(i);
        return;
      }
  };
  std::vector<Loop> loops;
  while (!next.empty()) {
    Loop loop{next.begin()->first};
    for (Index at = loop[0];;) {
      Index to = 0;
      if (const auto i = next.find(at); i != next.end()) {
        to = i->second;
        take(next, at, to);
        take(back, to, at);
      } else if (const auto j = back.find(at); j != back.end()) {  // against the direction: triangles disagree here
        to = j->second;
        take(back, at, to);
        take(next, to, at);
      } else {
        break;
      }
      if (to == loop[0]) break;
      loop.push_back(to);
      at = to;
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

Vec3 middle_of(const TetSurface& surface, const Loop& loop) {
  Vec3 sum = Vec3::Zero();
  for (const Index v : loop) sum += surface.vertices[v] / static_cast<double>(loop.size());
  return sum;
}

InputError open_error(const Shape& shape, const TetSurface& surface, const std::vector<Loop>& holes) {
  const Loop& largest =
      *std::max_element(holes.begin(), holes.end(), [](const Loop& a, const Loop& b) { return a.size() < b.size(); });
  const std::string edges = counted(largest.size(), "edge", "edges");
  const std::string place = place_text(shape, middle_of(surface, largest));
  return InputError(
      "expected faces that close around a solid, found " +
      (holes.size() == 1 ? "a hole of " + edges + " around " + place
                         : std::to_string(holes.size()) + " holes, the largest of " + edges + " around " + place) +
      "; holes of up to so many edges can be closed (close_holes " + std::to_string(largest.size()) + ")");
}

/// The edge of a triangle without area that its other corner lies on; 3 where it has area.
Index flat_edge(const TetSurface& surface, const Triangle& t) {
  Index longest = 0;
  double length = 0;
  for (Index k = 0; k < 3; ++k)
    if (const double l = (surface.vertices[t[(k + 1) % 3]] - surface.vertices[t[k]]).norm(); l > length) {
      longest = k;
      length = l;
    }
  const Vec3 &a = surface.vertices[t[0]], &b = surface.vertices[t[1]], &c = surface.vertices[t[2]];
  return (b - a).cross(c - a).norm() > 1e-13 * length * length ? 3 : longest;
}

}  // namespace

void check_edges(const Shape& shape, const TetSurface& surface) {
  std::size_t count = 0;
  std::string first;
  for_each_edge(sorted_edges(surface), [&](std::span<const Edge> same) {
    if (same.size() <= 2) return;
    ++count;
    if (!first.empty()) return;
    std::vector<Index> triangles;
    for (const Edge& edge : same) triangles.push_back(edge.triangle);
    first = "between points " + std::to_string(surface.points[same[0].low]) + " and " +
            std::to_string(surface.points[same[0].high]) + " in " + faces_text(surface, triangles) + ", at " +
            place_text(shape, surface.vertices[same[0].low]);
  });
  if (count > 0)
    throw InputError("expected edges of two faces each, found " + counted(count, "edge", "edges") +
                     " of more: " + (count > 1 ? "the first " : "") + first);
}

std::size_t close_holes_of(const Shape& shape, int longest, TetSurface& surface) {
  std::vector<Loop> holes = holes_of(surface);
  std::vector<Loop> open;
  for (const Loop& hole : holes)
    if (static_cast<std::ptrdiff_t>(hole.size()) > longest || hole.size() < 3) open.push_back(hole);
  if (!open.empty()) throw open_error(shape, surface, open);
  std::set<std::pair<Index, Index>> ends;
  if (!holes.empty())
    for (const Edge& edge : sorted_edges(surface)) ends.insert(edge.ends());
  for (const Loop& hole : holes) {
    std::vector<Vec3> places;
    for (const Index v : hole) places.push_back(surface.vertices[v]);
    const auto apart = [&](Index a, Index b) { return !ends.contains(std::minmax({hole[a], hole[b]})); };
    for (const Triangle& t : polygon_ears(places, apart)) {
      for (std::size_t k = 0; k < 3; ++k) ends.insert(std::minmax({hole[t[k]], hole[t[(k + 1) % 3]]}));
      surface.triangles.push_back({hole[t[0]], hole[t[1]], hole[t[2]]});
      surface.faces.push_back(TetSurface::no_face);
    }
  }
  if (holes.empty()) return 0;
  check_edges(shape, surface);
  if (const std::vector<Loop> left = holes_of(surface); !left.empty()) throw open_error(shape, surface, left);
  return holes.size();
}

std::size_t turn_faces(const Shape& shape, TetSurface& surface) {
  const std::vector<Index> opposite = opposite_edges(surface);
  const auto directed = [&](Index edge) {
    const Triangle& t = surface.triangles[edge / 3];
    return std::pair(t[edge % 3], t[(edge + 1 - (edge % 3 == 2 ? 3 : 0)) % 3]);
  };
  std::vector<signed char> turn(surface.triangles.size(), -1);  // -1: not reached
  std::vector<Index> part;
  std::size_t turned = 0;
  for (Index seed = 0; seed < turn.size(); ++seed) {
    if (turn[seed] >= 0) continue;
    turn[seed] = 0;
    part.assign(1, seed);
    std::size_t ones = 0;
    for (std::size_t k = 0; k < part.size(); ++k)
      for (Index e = 3 * part[k]; e < 3 * part[k] + 3; ++e) {
        const Index other = opposite[e] / 3;
        const bool agree = directed(e) != directed(opposite[e]);
        const auto wanted = static_cast<signed char>(agree ? turn[part[k]] : 1 - turn[part[k]]);
        if (turn[other] < 0) {
          turn[other] = wanted;
          ones += wanted == 1;
          part.push_back(other);
        } else if (turn[other] != wanted) {
          throw InputError("expected faces with an inside and an outside, found a one-sided surface around " +
                           place_text(shape, surface.vertices[surface.triangles[other][0]]));
        }
      }
    const signed char fewer = 2 * ones > part.size() ? 0 : 1;
    for (const Index t : part)
      if (turn[t] == fewer) {
        std::swap(surface.triangles[t][1], surface.triangles[t][2]);
        ++turned;
      }
  }
  return turned;
}

std::vector<Index> opposite_edges(const TetSurface& surface) {
  std::vector<Index> opposite(3 * surface.triangles.size());
  const auto slot = [&](const Edge& edge) {
    const Triangle& t = surface.triangles[edge.triangle];
    for (Index k = 0; k < 3; ++k)
      if (std::minmax(t[k], t[(k + 1) % 3]) == std::pair<const Index&, const Index&>(edge.low, edge.high))
        return 3 * edge.triangle + k;
    return Index{0};
  };
  for_each_edge(sorted_edges(surface), [&](std::span<const Edge> same) {
    const Index a = slot(same.front()), b = slot(same.back());
    opposite[a] = b;
    opposite[b] = a;
  });
  return opposite;
}

bool is_closed(const TetSurface& surface) {
  bool closed = true;
  for_each_edge(sorted_edges(surface), [&](std::span<const Edge> same) {
    closed = closed && same.size() == 2 && same[0].rises != same[1].rises;
  });
  return closed;
}

std::size_t join_flat_triangles(TetSurface& surface) {
  std::size_t joined = 0;
  for (int pass = 0; pass < 20; ++pass) {  // a triangle that takes an edge over may itself be flat
    std::vector<Index> flat;
    for (Index t = 0; t < surface.triangles.size(); ++t)
      if (flat_edge(surface, surface.triangles[t]) < 3) flat.push_back(t);
    if (flat.empty()) return joined;
    const std::vector<Index> opposite = opposite_edges(surface);
    std::vector<std::pair<Index, Index>> ends;
    for (const Edge& edge : sorted_edges(surface)) ends.push_back(edge.ends());
    std::vector<char> touched(surface.triangles.size(), 0);
    std::size_t changed = 0;
    for (const Index t : flat) {
      const Index k = flat_edge(surface, surface.triangles[t]), across = opposite[3 * t + k], s = across / 3;
      const Index u = surface.triangles[t][k], v = surface.triangles[t][(k + 1) % 3],
                  b = surface.triangles[t][(k + 2) % 3], d = surface.triangles[s][(across % 3 + 2) % 3];
      const auto cut = std::pair(std::min(b, d), std::max(b, d));
      if (touched[t] || touched[s] || b == d || std::binary_search(ends.begin(), ends.end(), cut)) continue;
      surface.triangles[t] = {b, u, d};
      surface.triangles[s] = {v, b, d};
      surface.faces[t] = surface.faces[s];
      touched[t] = touched[s] = 1;
      ++changed;
    }
    joined += changed;
    if (changed == 0) break;
  }
  std::vector<Index> left;
  for (Index t = 0; t < surface.triangles.size(); ++t)
    if (flat_edge(surface, surface.triangles[t]) < 3) left.push_back(t);
  if (left.empty()) return joined;
  throw InputError("expected faces with an area, found none that can be had by joining neighbours in " +
                   faces_text(surface, left));
}

}  // namespace sinew
