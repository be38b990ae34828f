#include "engine/geometry/skin.h"

#include <Eigen/Geometry>
#include <cmath>

#include "engine/geometry/parallel.h"

namespace sinew {

namespace {

constexpr std::size_t block = 4096;  ///< points of one parallel block

/// [A - I | t] column by column, padded to whole vectors of four.
using Padded = Eigen::Matrix<double, 4, 4>;

std::vector<Padded> displacements(const Pose& pose) {
  std::vector<Padded> out(pose.size());
  for (std::size_t j = 0; j < pose.size(); ++j) {
    out[j].setZero();
    out[j].topRows<3>() = pose[j] - identity_map();
  }
  return out;
}

/// Sum of the maps of row i, in the row's order.
Padded blend(const SkinWeights& weights, const std::vector<Padded>& D, std::size_t i) {
  Padded sum = Padded::Zero();
  for (std::uint64_t e = weights.offsets[i]; e < weights.offsets[i + 1]; ++e)
    sum += static_cast<double>(weights.weights[e]) * D[weights.maps[e]];
  return sum;
}

Vec3 row(const Attribute& attribute, std::size_t i) {
  return {attribute.number(i, 0), attribute.number(i, 1), attribute.number(i, 2)};
}

bool bends(const Attribute& attribute) {
  const bool kind = attribute.kind == Kind::Point || attribute.kind == Kind::Vector ||
                    attribute.kind == Kind::Velocity || attribute.kind == Kind::Normal;
  return kind && attribute.components == 3;
}

/// Value i of an attribute under the map p -> M p + t (t with the shape's origin folded in).
Vec3 bend(Kind kind, const Mat3& M, const Vec3& t, const Vec3& value) {
  if (kind == Kind::Normal) return skin_normal(M, value);
  return kind == Kind::Point ? Vec3(M * value + t) : Vec3(M * value);
}

/// `in` and `out` are the same attribute before and after.
void bend_attribute(const Attribute& in, const Shape& rest, const SkinWeights& weights, const std::vector<Padded>& D,
                    Attribute& out) {
  parallel_for(in.count(), block, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t first = in.per_point() ? 0 : in.point_offsets[i];
      const std::size_t last = in.per_point() ? 1 : in.point_offsets[i + 1];
      Padded sum = Padded::Zero();
      for (std::size_t k = first; k < last; ++k) sum += blend(weights, D, in.per_point() ? i : in.points[k]);
      if (last == first || sum.isZero(0)) continue;  // identity maps: the value keeps its bits
      sum /= static_cast<double>(last - first);
      const Mat3 M = Mat3::Identity() + sum.topLeftCorner<3, 3>();
      const Vec3 t = sum.topRightCorner<3, 1>() + rest.origin - M * rest.origin;
      const Vec3 value = bend(in.kind, M, t, row(in, i));
      if (!value.allFinite()) continue;
      for (int c = 0; c < 3; ++c) out.set_number(i, c, value[c]);
    }
  });
}

}  // namespace

void skin_points(const SkinWeights& weights, const Pose& pose, std::span<const Vec3> in, std::span<Vec3> out) {
  CHECK(weights.size() == in.size() && out.size() == in.size(), weights.size(), in.size(), out.size());
  const std::vector<Padded> D = displacements(pose);
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
  const std::vector<Padded> D = displacements(pose);
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

Shape skin(const Shape& rest, const SkinWeights& weights, const Pose& pose) {
  Shape out = rest;
  skin_points(weights, pose, rest.positions, out.positions);
  const std::vector<Padded> D = displacements(pose);
  for (std::size_t a = 0; a < rest.attributes.size(); ++a)
    if (bends(rest.attributes[a])) bend_attribute(rest.attributes[a], rest, weights, D, out.attributes[a]);
  return out;
}

}  // namespace sinew
