#pragma once
/// The pose of a shell: a map for each vertex, and which vertices other points follow.
///
/// A triangle maps (a, b, c, a + n) onto (a', b', c', a' + n'), n the unit normals. A vertex has the mean of the linear
/// parts of its triangles, by area, and is carried exactly. A point of the surface follows the three vertices of its
/// triangle by barycentric coordinates, any other point those of the nearest triangle: the maps differ little from
/// vertex to vertex, so nothing breaks where triangles meet.

#include <span>
#include <vector>

#include "deformers/shell_mesh.h"
#include "engine/geometry/deformer.h"

namespace sinew {

/// Of each vertex; the identity where it and its neighbours are where they were, to the last bit.
Pose vertex_maps(std::span<const Vec3> rest, std::span<const Vec3> x, std::span<const Triangle> triangles);

/// Triangles near a place. Those of the nearest vertices and midpoints are looked at.
class ShellSurface {
 public:
  ShellSurface(std::vector<Vec3> vertices, std::vector<Triangle> triangles)
      : vertices_(std::move(vertices)), triangles_(std::move(triangles)) {}

  struct Foot {
    Index triangle = 0;
    Vec3 weights = Vec3::Zero();  ///< barycentric, each 0..1
    double distance = 0;
  };
  /// The nearest point of the surface to each of `points`, which are finite.
  std::vector<Foot> feet(std::span<const Vec3> points) const;

  /// Points at the place of a vertex follow that alone. A point that is not finite has an empty row.
  SkinWeights bind(std::span<const Vec3> points, Gradients gradients) const;

  std::vector<Deformer::Table> tables() const;
  /// Throws InputError about the tables.
  static ShellSurface from_tables(const std::vector<Deformer::Table>& tables);

  const std::vector<Vec3>& vertices() const { return vertices_; }
  const std::vector<Triangle>& triangles() const { return triangles_; }

 private:
  std::vector<Vec3> vertices_;
  std::vector<Triangle> triangles_;
};

}  // namespace sinew
