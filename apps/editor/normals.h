#pragma once
/// The normals that a shape is lit by.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew::editor {

/// Unit normals of the points: the file's, or of a mesh the mean of its faces' (weighted by area); none for others.
std::vector<Vec3> normals_of(const Shape& shape, std::span<const std::uint32_t> triangles);

}  // namespace sinew::editor
