#include "deformers/shell_pose.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <set>

#include "engine/geometry/error.h"
#include "engine/geometry/nearest.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/triangle.h"

namespace sinew {

namespace {

/// CSR lists of the triangles at each vertex.
struct Rings {
  std::vector<Index> offsets, triangles;

  Rings(std::size_t vertices, std::span<const Triangle> all) : offsets(vertices + 1, 0) {
    for (const Triangle& t : all)
      for (const Index v : t) ++offsets[v + 1];
    for (std::size_t v = 0; v < vertices; ++v) offsets[v + 1] += offsets[v];
    triangles.resize(offsets.back());
    std::vector<Index> at(offsets.begin(), offsets.end() - 1);
    for (Index t = 0; t < all.size(); ++t)
      for (const Index v : all[t]) triangles[at[v]++] = t;
  }
  std::span<const Index> operator[](std::size_t v) const {
    return {triangles.data() + offsets[v], triangles.data() + offsets[v + 1]};
  }
};

/// The linear part of a triangle's map, times twice its area; zero where it has none.
Mat3 linear_part(const Triangle& t, std::span<const Vec3> rest, std::span<const Vec3> x) {
  const auto frame = [&](std::span<const Vec3> p, double& area) {
    Mat3 F;
    F.col(0) = p[t[1]] - p[t[0]];
    F.col(1) = p[t[2]] - p[t[0]];
    F.col(2) = F.col(0).cross(F.col(1));
    area = F.col(2).norm();
    if (area > 0) F.col(2) /= area;
    return F;
  };
  double area = 0, bent_area = 0;
  const Mat3 before = frame(rest, area), after = frame(x, bent_area);
  const double size = before.col(0).squaredNorm() + before.col(1).squaredNorm();
  if (!(area > 1e-9 * size) || bent_area <= 0) return Mat3::Zero();
  return area * after * before.inverse();
}

Index index_of(double value, std::size_t count) {
  if (!(value >= 0 && value < static_cast<double>(count) && value == std::floor(value)))
    throw InputError("expected vertices below " + std::to_string(count) + " in \"triangles\", found " +
                     std::to_string(value));
  return static_cast<Index>(value);
}

/// A tree over vertices and midpoints of triangles, and the triangles at each of these.
struct Search {
  static constexpr int nearest = 8;
  Rings rings;
  NearestTree tree;

  static std::vector<Vec3> places(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles) {
    std::vector<Vec3> out = vertices;
    for (const Triangle& t : triangles) out.push_back((vertices[t[0]] + vertices[t[1]] + vertices[t[2]]) / 3);
    return out;
  }
  Search(const std::vector<Vec3>& vertices, const std::vector<Triangle>& triangles)
      : rings(vertices.size(), triangles), tree(places(vertices, triangles)) {}
};

}  // namespace

Pose vertex_maps(std::span<const Vec3> rest, std::span<const Vec3> x, std::span<const Triangle> triangles) {
  const std::size_t n = rest.size();
  const Rings rings(n, triangles);
  std::vector<Mat3> parts(triangles.size());
  std::vector<char> moved(triangles.size());
  parallel_for(triangles.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      const Triangle& c = triangles[t];
      moved[t] = std::any_of(c.begin(), c.end(), [&](Index v) { return x[v] != rest[v]; });
      if (moved[t])
        parts[t] = linear_part(c, rest, x);
      else
        parts[t] = (rest[c[1]] - rest[c[0]]).cross(rest[c[2]] - rest[c[0]]).norm() * Mat3::Identity();
    }
  });
  Pose maps(n, identity_map());
  parallel_for(n, 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto ring = rings[v];
      if (std::none_of(ring.begin(), ring.end(), [&](Index t) { return moved[t] != 0; })) continue;
      Mat3 sum = Mat3::Zero();
      double area = 0;
      for (const Index t : ring) {
        if (parts[t].squaredNorm() <= 0) continue;
        sum += parts[t];
        const Triangle& c = triangles[t];
        area += (rest[c[1]] - rest[c[0]]).cross(rest[c[2]] - rest[c[0]]).norm();
      }
      if (area > 0) maps[v].leftCols<3>() = sum / area;
      maps[v].col(3) = x[v] - maps[v].leftCols<3>() * rest[v];
    }
  });
  return maps;
}

std::vector<ShellSurface::Foot> ShellSurface::feet(std::span<const Vec3> points) const {
  const Search search(vertices_, triangles_);
  std::vector<std::uint32_t> found(points.size() * Search::nearest);
  std::vector<double> distances(found.size());
  search.tree.nearest(points, Search::nearest, found, distances);
  std::vector<Foot> out(points.size());
  parallel_for(points.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      out[i].distance = INFINITY;
      const auto look = [&](Index t) {
        const Triangle& c = triangles_[t];
        const Vec3 w = nearest_in_triangle(points[i], vertices_[c[0]], vertices_[c[1]], vertices_[c[2]]);
        const Vec3 foot = w[0] * vertices_[c[0]] + w[1] * vertices_[c[1]] + w[2] * vertices_[c[2]];
        const double distance = (points[i] - foot).norm();
        if (distance < out[i].distance || (distance == out[i].distance && t < out[i].triangle))
          out[i] = {t, w, distance};
      };
      for (std::size_t k = i * Search::nearest; k < (i + 1) * Search::nearest; ++k) {
        const std::size_t place = found[k];
        if (found[k] == NearestTree::none) continue;
        if (place >= vertices_.size())
          look(static_cast<Index>(place - vertices_.size()));
        else
          for (const Index t : search.rings[place]) look(t);
      }
    }
  });
  return out;
}

SkinWeights ShellSurface::bind(std::span<const Vec3> points, Gradients gradients) const {
  std::vector<Vec3> finite;
  for (const Vec3& p : points)
    if (p.allFinite()) finite.push_back(p);
  const std::vector<Foot> all = feet(finite);
  SkinWeights out;
  std::size_t next = 0;
  for (const Vec3& p : points) {
    if (p.allFinite()) {
      const Foot& foot = all[next++];
      const Triangle& c = triangles_[foot.triangle];
      const Vec3 &a = vertices_[c[0]], &b = vertices_[c[1]], &d = vertices_[c[2]];
      const Vec3 n = (b - a).cross(d - a);
      const double square = n.squaredNorm();
      const bool inside = foot.weights.minCoeff() > 0 && square > 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double w = foot.weights[static_cast<Eigen::Index>(k)];
        if (w <= 0) continue;
        out.maps.push_back(c[k]);
        out.weights.push_back(static_cast<float>(w));
        if (gradients == Gradients::No) continue;
        // Of a barycentric coordinate; beside the surface the foot slides along a side or rests on a corner.
        const Vec3 side = vertices_[c[(k + 2) % 3]] - vertices_[c[(k + 1) % 3]];
        out.gradients.push_back(inside ? Eigen::Vector3f((n.cross(side) / square).cast<float>())
                                       : Eigen::Vector3f(Eigen::Vector3f::Zero()));
      }
    }
    out.offsets.push_back(out.maps.size());
  }
  return out;
}

std::vector<Deformer::Table> ShellSurface::tables() const {
  std::vector<Deformer::Table> out{{"vertices", 3, {}}, {"triangles", 3, {}}};
  for (const Vec3& p : vertices_) out[0].values.insert(out[0].values.end(), p.data(), p.data() + 3);
  for (const Triangle& t : triangles_) out[1].values.insert(out[1].values.end(), t.begin(), t.end());
  return out;
}

ShellSurface ShellSurface::from_tables(const std::vector<Deformer::Table>& tables) {
  const auto find = [&](const char* name) -> const std::vector<double>& {
    for (const Deformer::Table& table : tables)
      if (table.name == name && table.columns == 3 && !table.values.empty()) return table.values;
    throw InputError("expected a table \"" + std::string(name) + "\" of the shell's binding, found none");
  };
  std::vector<Vec3> vertices;
  const std::vector<double>&points = find("vertices"), &corners = find("triangles");
  for (std::size_t i = 0; i + 2 < points.size(); i += 3) {
    vertices.emplace_back(points[i], points[i + 1], points[i + 2]);
    if (!vertices.back().allFinite()) throw InputError("expected finite \"vertices\", found one that is not");
  }
  std::vector<Triangle> triangles;
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    triangles.push_back({index_of(corners[i], vertices.size()), index_of(corners[i + 1], vertices.size()),
                         index_of(corners[i + 2], vertices.size())});
  return {std::move(vertices), std::move(triangles)};
}

}  // namespace sinew
