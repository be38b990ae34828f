#include "apps/editor/volume.h"

#include <algorithm>
#include <cmath>

namespace sinew::editor {

Volume volume_around(Volume::Kind kind, const Bounds& bounds, double least) {
  constexpr double margin = 1.02;
  Volume out;
  out.centre = bounds.centre();
  out.half = (margin * 0.5 * (bounds.max - bounds.min)).cwiseMax(least);
  return with_kind(out, kind);
}

Volume with_kind(const Volume& volume, Volume::Kind kind) {
  Volume out = volume;
  out.kind = kind;
  if (kind == Volume::Kind::Sphere) out.half = Vec3::Constant(volume.half.maxCoeff());
  return out;
}

Volume transformed(const Volume& volume, const Transform& by) {
  Volume out = volume;
  out.centre = by.stretch * (volume.centre - by.pivot) + by.pivot + by.move;
  Vec3 factors = by.stretch.diagonal();
  if (volume.kind == Volume::Kind::Sphere) {
    Eigen::Index farthest = 0;
    (factors.array() - 1).abs().maxCoeff(&farthest);
    factors.setConstant(factors[farthest]);
  }
  out.half = volume.half.cwiseProduct(factors);
  return out;
}

PointSet in_volume(std::span<const Vec3> positions, const Volume& volume) {
  const Vec3 centre = volume.centre, half = volume.half;
  if (volume.kind == Volume::Kind::Sphere) return in_capsule(positions, centre, centre, half.x());
  return set_where(positions.size(), [&](std::size_t i) {
    const Vec3 d = (positions[i] - centre).cwiseAbs();
    return d.x() <= half.x() && d.y() <= half.y() && d.z() <= half.z();
  });
}

PointSet in_capsule(std::span<const Vec3> positions, const Vec3& a, const Vec3& b, double radius) {
  const Vec3 along = b - a;
  const double length2 = along.squaredNorm(), radius2 = radius * radius;
  const double inverse = length2 > 0 ? 1 / length2 : 0;
  return set_where(positions.size(), [&](std::size_t i) {
    const Vec3 d = positions[i] - a;
    const double t = std::clamp(d.dot(along) * inverse, 0.0, 1.0);
    return (d - t * along).squaredNorm() <= radius2;
  });
}

}  // namespace sinew::editor
