#include "engine/geometry/skin.h"

#include <Eigen/Geometry>

#include "engine/geometry/parallel.h"
#include "engine/geometry/skin_attributes.h"
#include "engine/geometry/skin_maps.h"

namespace sinew {

namespace {

constexpr std::size_t block = 4096;  ///< points of one parallel block

}  // namespace

void skin_points(const SkinWeights& weights, const Pose& pose, std::span<const Vec3> in, std::span<Vec3> out) {
  CHECK(weights.size() == in.size() && out.size() == in.size(), weights.size(), in.size(), out.size());
  const std::vector<Padded> D = padded(pose, identity_map());
  parallel_for(in.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 p = in[i];
      Eigen::Vector4d d = Eigen::Vector4d::Zero();
      for (std::uint64_t e = weights.offsets[i]; e < weights.offsets[i + 1]; ++e) {
        const Padded& m = D[weights.maps[e]];
        d += static_cast<double>(weights.weights[e]) *
             (m.col(0) * p.x() + m.col(1) * p.y() + m.col(2) * p.z() + m.col(3));
      }
      // What does not move keeps its bits, -0 and NaN too.
      const bool moves = (d.array() != 0).any() && p.allFinite();
      out[i] = moves ? Vec3(p + d.head<3>()) : p;
    }
  });
}

void blend_matrices(const SkinWeights& weights, const Pose& pose, std::size_t first, std::span<Mat3> out) {
  CHECK(first + out.size() <= weights.size(), first, out.size(), weights.size());
  const std::vector<Padded> D = padded(pose, identity_map());
  parallel_for(out.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      out[i] = Mat3::Identity() + blend(weights, D, first + i).topLeftCorner<3, 3>();
  });
}

Vec3 skin_normal(const Mat3& M, const Vec3& n) {
  Mat3 cofactor;
  for (int c = 0; c < 3; ++c) cofactor.col(c) = M.col((c + 1) % 3).cross(M.col((c + 2) % 3));
  const Vec3 turned = cofactor * n;
  const double length = turned.norm();
  return length > 0 ? Vec3(turned * (n.norm() / length)) : n;
}

Shape skin(const Shape& rest, const SkinWeights& weights, const Pose& pose, const Pose* rate) {
  Shape out = rest;
  skin_points(weights, pose, rest.positions, out.positions);
  bend_attributes(rest, weights, pose, rate, out);
  return out;
}

}  // namespace sinew
