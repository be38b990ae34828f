#include "engine/geometry/skin.h"

#include <Eigen/Geometry>

#include "engine/geometry/parallel.h"
#include "engine/geometry/skin_attributes.h"
#include "engine/geometry/skin_maps.h"

namespace sinew {

namespace {

constexpr std::size_t block = 4096;  ///< points of one parallel block

/// Two columns of a map, as they lie in memory.
typedef double Columns __attribute__((vector_size(8 * sizeof(double)), aligned(32), may_alias));

/// sum += w D.
inline void add(const Padded& D, double w, Columns (&sum)[2]) {
  const auto* columns = reinterpret_cast<const Columns*>(D.data());
  sum[0] += w * columns[0];
  sum[1] += w * columns[1];
}

}  // namespace

void skin_points(const SkinWeights& weights, const Pose& pose, std::span<const Vec3> in, std::span<Vec3> out) {
  CHECK(weights.size() == in.size() && out.size() == in.size(), weights.size(), in.size(), out.size());
  const std::vector<Padded> D = padded(pose, identity_map());
  parallel_for(in.size(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3 p = in[i];
      // The maps are blended first, two columns at a time, two influences side by side: in one sum, each addition would
      // wait for the last.
      Columns first[2] = {}, second[2] = {};
      std::uint64_t e = weights.offsets[i];
      const std::uint64_t last = weights.offsets[i + 1];
      for (; e + 2 <= last; e += 2) {
        add(D[weights.maps[e]], static_cast<double>(weights.weights[e]), first);
        add(D[weights.maps[e + 1]], static_cast<double>(weights.weights[e + 1]), second);
      }
      if (e < last) add(D[weights.maps[e]], static_cast<double>(weights.weights[e]), first);
      const Columns xy = first[0] + second[0], zt = first[1] + second[1];
      Vec3 d;
      for (int r = 0; r < 3; ++r) d[r] = xy[r] * p.x() + xy[4 + r] * p.y() + zt[r] * p.z() + zt[4 + r];
      // What does not move keeps its bits, -0 and NaN too.
      const bool moves = (d.array() != 0).any() && p.allFinite();
      out[i] = moves ? Vec3(p + d) : p;
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
