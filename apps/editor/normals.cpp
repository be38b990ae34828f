#include "apps/editor/normals.h"

#include <Eigen/Geometry>

namespace sinew::editor {

std::vector<Vec3> normals_of(const Shape& shape, std::span<const std::uint32_t> triangles) {
  std::vector<Vec3> normals;
  for (const Attribute& attribute : shape.attributes) {
    if (attribute.kind != Kind::Normal || attribute.components != 3 || !attribute.per_point()) continue;
    normals.resize(shape.size());
    for (std::size_t i = 0; i < shape.size(); ++i)
      normals[i] = {attribute.number(i, 0), attribute.number(i, 1), attribute.number(i, 2)};
    return normals;
  }
  if (triangles.empty()) return normals;
  normals.assign(shape.size(), Vec3::Zero());
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3) {
    const Vec3& a = shape.positions[triangles[t]];
    const Vec3 area = (shape.positions[triangles[t + 1]] - a).cross(shape.positions[triangles[t + 2]] - a);
    for (std::size_t c = 0; c < 3; ++c) normals[triangles[t + c]] += area;
  }
  for (Vec3& normal : normals) normal.normalize();
  return normals;
}

}  // namespace sinew::editor
