#pragma once
/// The triangles that a shell is made of: a shape's faces over vertices that several points may share, in the rest pose
/// and in any number of example poses.

#include <array>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew {

using Triangle = std::array<Index, 3>;

struct ShellMesh {
  static constexpr Index none = ~Index{0};
  std::vector<std::vector<Vec3>> poses;  ///< of the vertices: at rest, then each example; relative to the rest's origin
  std::vector<Vec3>
      source;  ///< of the vertices: what the examples are poses of, where that is another shape; else none
  std::vector<Triangle> triangles;     ///< of three different vertices each
  std::vector<Index> vertex_of_point;  ///< none: the point is on no face, or not finite
  std::vector<Index> point_of_vertex;  ///< the lowest of its points
  std::vector<std::string> notes;      ///< what was left out or shared, one sentence with a count each

  const std::vector<Vec3>& rest() const { return poses.front(); }
  std::size_t size() const { return point_of_vertex.size(); }  ///< vertices
};

/// Polygons become fans of triangles. Points at the very same place in all poses (an unwelded seam) are one vertex.
/// Throws InputError where the shape has no face with an extent, or an example does not correspond: another number of
/// points, another face (the first one is named), a point that is not finite where the rest's is.
/// `source`: what the examples are poses of; null: the shape itself.
ShellMesh shell_mesh_of(const Shape& rest, std::span<const std::shared_ptr<const Shape>> examples,
                        const Shape* source = nullptr);

}  // namespace sinew
