#include "engine/document/pose_blend.h"

#include <Eigen/Geometry>

#include "engine/geometry/affine.h"

namespace sinew::document {

Pose blended(const PosedStructure& first, const PosedStructure& second, double u, const Deformer::Structure& now) {
  Pose out = first.pose;
  CHECK(second.pose.size() == out.size(), second.pose.size(), out.size());
  for (std::size_t v = 0; v < now.vertices.size(); ++v) {
    const Index map = now.maps[v];
    const Affine &a = first.pose[map], &b = second.pose[map];
    const Vec3 &g0 = first.structure.vertices[v], &g1 = second.structure.vertices[v], &g = now.vertices[v];
    const Vec3 d0 = a.leftCols<3>() * g0 + a.col(3) - g0, d1 = b.leftCols<3>() * g1 + b.col(3) - g1;
    const Mat3 A = sinew::blended(Mat3(a.leftCols<3>()), Mat3(b.leftCols<3>()), u);
    out[map] << A, g + (1 - u) * d0 + u * d1 - A * g;
  }
  return out;
}

}  // namespace sinew::document
