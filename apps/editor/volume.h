#pragma once
/// Volumes: a box or a sphere in space, and the balls along a stroke of the sphere brush, as sets of points. World
/// coordinates. One pass over all points each: 1,000,000 within a frame (tests/apps/editor_core_select_test.cpp).

#include "apps/editor/marks.h"
#include "apps/editor/point_set.h"
#include "engine/geometry/bounds.h"

namespace sinew::editor {

struct Volume {
  enum class Kind { Box, Sphere } kind = Kind::Box;
  Vec3 centre = Vec3::Zero();
  Vec3 half = Vec3::Ones();  ///< half the sides of a box, along the axes of the scene; of a sphere all are the radius
  bool operator==(const Volume&) const = default;
};

/// A little larger than `bounds`; at least `least` wide to each side.
Volume volume_around(Volume::Kind kind, const Bounds& bounds, double least);
/// The same place as another kind.
Volume with_kind(const Volume& volume, Volume::Kind kind);
/// Moved and scaled; turns do not count. A sphere takes the factor that is farthest from 1.
Volume transformed(const Volume& volume, const Transform& by);

PointSet in_volume(std::span<const Vec3> positions, const Volume& volume);

/// Points within `radius` of the segment from `a` to `b` (the same: a ball).
PointSet in_capsule(std::span<const Vec3> positions, const Vec3& a, const Vec3& b, double radius);

}  // namespace sinew::editor
