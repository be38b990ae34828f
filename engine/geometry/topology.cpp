#include "engine/geometry/topology.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "engine/geometry/nearest.h"
#include "engine/geometry/union_find.h"

namespace sinew {

namespace {

double edge_length(std::span<const Vec3> p, const std::pair<Index, Index>& edge) {
  return (p[edge.second] - p[edge.first]).norm();
}

/// Closed and consistently oriented: every directed edge stands once, beside its opposite.
bool is_closed(const Faces& faces) {
  std::vector<std::pair<Index, Index>> directed;
  directed.reserve(faces.points.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto corners = faces[f];
    for (std::size_t c = 0; c < corners.size(); ++c)
      directed.emplace_back(corners[c], corners[(c + 1) % corners.size()]);
  }
  std::sort(directed.begin(), directed.end());
  if (std::adjacent_find(directed.begin(), directed.end()) != directed.end()) return false;
  return !directed.empty() && std::all_of(directed.begin(), directed.end(), [&](const auto& e) {
    return std::binary_search(directed.begin(), directed.end(), std::pair{e.second, e.first});
  });
}

double volume_of(std::span<const Vec3> p, std::span<const Index> triangles) {
  const Vec3 near = p[triangles[0]];  // a point of the shape: far from the origin the sum would cancel
  double sum = 0;
  for (std::size_t t = 0; t < triangles.size(); t += 3)
    sum += (p[triangles[t]] - near).dot((p[triangles[t + 1]] - near).cross(p[triangles[t + 2]] - near));
  return sum / 6;
}

}  // namespace

void join_near_points(std::span<const Vec3> positions, const std::function<void(Index, Index)>& join) {
  constexpr int k = 9;  // 8 and the point itself
  std::vector<Index> finite;
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!positions[i].allFinite()) continue;
    finite.push_back(static_cast<Index>(i));
    points.push_back(positions[i]);
  }
  const NearestTree tree(points);
  std::vector<Index> near(points.size() * k);
  std::vector<double> distance(points.size() * k);
  tree.nearest(points, k, near, distance);

  std::vector<double> gaps;  // to the nearest point at another place: duplicates say nothing of the spacing
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t n = 0; n < k; ++n)
      if (const double d = distance[i * k + n]; d > 0 && std::isfinite(d)) {
        gaps.push_back(d);
        break;
      }
  double reach = 0;
  if (!gaps.empty()) {
    const auto middle = gaps.begin() + static_cast<std::ptrdiff_t>(gaps.size() / 2);
    std::nth_element(gaps.begin(), middle, gaps.end());
    reach = 4 * *middle;
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    for (std::size_t n = 0; n < k; ++n)
      if (const Index j = near[i * k + n]; j != NearestTree::none && distance[i * k + n] <= reach)
        join(finite[i], finite[j]);
}

Components connected_components(const Shape& shape) {
  UnionFind sets(shape.size());
  if (shape.faces.empty() && shape.tets.empty())
    join_near_points(shape.positions, [&](Index a, Index b) { sets.join(a, b); });
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    const auto corners = shape.faces[f];
    for (const Index p : corners) sets.join(corners[0], p);
  }
  for (const Tet& tet : shape.tets)
    for (const Index p : tet) sets.join(tet[0], p);
  Components out;
  out.of_point.assign(shape.size(), Components::none);
  for (Index i = 0; i < shape.size(); ++i) {
    if (!shape.positions[i].allFinite()) continue;
    const Index root = sets.root(i);
    // A root is the lowest of its set, but it may itself not be finite: the set is numbered where it is first met.
    if (out.of_point[root] == Components::none) out.of_point[root] = static_cast<Index>(out.count++);
    out.of_point[i] = out.of_point[root];
  }
  for (Index i = 0; i < shape.size(); ++i)
    if (!shape.positions[i].allFinite()) out.of_point[i] = Components::none;
  return out;
}

std::vector<std::pair<Index, Index>> edges_of(const Faces& faces) {
  std::vector<std::pair<Index, Index>> edges;
  edges.reserve(faces.points.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto corners = faces[f];
    for (std::size_t c = 0; c < corners.size(); ++c) {
      const Index a = corners[c], b = corners[(c + 1) % corners.size()];
      if (a != b) edges.emplace_back(std::min(a, b), std::max(a, b));
    }
  }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

std::vector<Index> triangles_of(const Faces& faces) {
  std::vector<Index> triangles;
  triangles.reserve(faces.points.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const auto corners = faces[f];
    for (std::size_t c = 2; c < corners.size(); ++c) {
      triangles.push_back(corners[0]);
      triangles.push_back(corners[c - 1]);
      triangles.push_back(corners[c]);
    }
  }
  return triangles;
}

std::vector<Vec3> vertex_normals(const Shape& shape) {
  std::vector<Vec3> normals(shape.size(), Vec3::Zero());
  const std::vector<Index> triangles = triangles_of(shape.faces);
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const Vec3& a = shape.positions[triangles[t]];
    const Vec3 area = (shape.positions[triangles[t + 1]] - a).cross(shape.positions[triangles[t + 2]] - a);
    if (!area.allFinite()) continue;
    for (std::size_t c = 0; c < 3; ++c) normals[triangles[t + c]] += area;
  }
  for (Vec3& n : normals) {
    const double length = n.norm();
    n = length > 0 ? Vec3(n / length) : Vec3(Vec3::Zero());
  }
  return normals;
}

Quality quality_of(const Shape& rest, std::span<const Vec3> bent) {
  CHECK(bent.size() == rest.size(), bent.size(), rest.size());
  Quality quality;
  double sum = 0;
  std::size_t count = 0;
  for (const auto& edge : edges_of(rest.faces)) {
    const double length = edge_length(rest.positions, edge);
    if (!(length > 0)) continue;
    const double strain = edge_length(bent, edge) / length - 1;
    if (!std::isfinite(strain)) continue;
    sum += strain * strain;
    quality.edge_max = std::max(quality.edge_max, std::abs(strain));
    ++count;
  }
  quality.has_edges = count > 0;
  if (count > 0) quality.edge_rms = std::sqrt(sum / static_cast<double>(count));

  if (is_closed(rest.faces)) {
    const std::vector<Index> triangles = triangles_of(rest.faces);
    const double before = volume_of(rest.positions, triangles), after = volume_of(bent, triangles);
    quality.closed = before != 0 && std::isfinite(after / before);
    if (quality.closed) quality.volume_change = after / before - 1;
  }
  return quality;
}

std::string difference_of_faces(const Shape& shape, const Shape& other) {
  const auto corners = [](std::span<const Index> face) {
    std::string out;
    for (std::size_t k = 0; k < face.size() && k < 8; ++k) out += (k > 0 ? " " : "") + std::to_string(face[k]);
    return out + (face.size() > 8 ? " ..." : "");
  };
  if (shape.size() != other.size())
    return "expected " + std::to_string(shape.size()) + " points, found " + std::to_string(other.size());
  const std::size_t a = shape.faces.size(), b = other.faces.size();
  for (std::size_t f = 0; f < std::min(a, b); ++f)
    if (!std::ranges::equal(shape.faces[f], other.faces[f]))
      return "expected face " + std::to_string(f) + " of " + std::to_string(a) + " to have corners " +
             corners(shape.faces[f]) + ", found " + corners(other.faces[f]) + " (of " + std::to_string(b) + " faces)";
  if (a != b) return "expected " + std::to_string(a) + " faces, found " + std::to_string(b);
  for (std::size_t i = 0; i < shape.size(); ++i)
    if (shape.positions[i].allFinite() && !other.positions[i].allFinite())
      return "expected point " + std::to_string(i) + " to be finite, found one that is not";
  return {};
}

}  // namespace sinew
