#pragma once
/// Solid: the faces of a solid's tets, whole or cut by a plane, as triangles to draw.

#include <array>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "engine/geometry/shape.h"
#include "engine/gpu/points.h"
#include "engine/gpu/scene.h"

namespace sinew::gpu {

/// A cut: only tets whose middle is below a plane are seen.
struct Section {
  int axis = 0;     ///< 0 x, 1 y, 2 z
  double at = 0.5;  ///< part of the solid's extent along the axis that is seen
  bool operator==(const Section&) const = default;
};

/// Faces that bound the tets that are seen.
struct SolidFaces {
  std::vector<std::array<Index, 3>> faces;     ///< vertices of the solid
  std::vector<bool> inner;                     ///< of each face: the cut laid it bare
  std::vector<std::pair<Index, Index>> edges;  ///< of the faces, each once
};

/// `rest`: the vertices at rest, where the cut is made, so that it stays within the material.
SolidFaces faces_of(std::span<const Vec3> rest, std::span<const Tet> tets, const std::optional<Section>& section);

/// Colour of a part that is so many times as stiff as the rest: from green (softer) over `plain` to red (stiffer), full
/// at 16 times. Marks stay.
PointColor stiffness_color(PointColor plain, double factor);

/// The faces on the device, three points each.
struct SolidItem {
  Points points;
  Triangles triangles;
};
/// `at`: where the vertices are; `colors`: of each vertex. Faces that the cut laid bare are tinted.
SolidItem create_solid(const Device& device, const SolidFaces& faces, std::span<const Vec3> at,
                       std::span<const PointColor> colors);

/// Edges of the faces as lines.
void add_edges(const SolidFaces& faces, std::span<const Vec3> at, const Line& like, Scene& scene);

}  // namespace sinew::gpu
