#pragma once
/// A new PLY file of a shape that did not come from one.

#include <cstddef>
#include <vector>

#include "engine/io/io.h"

namespace sinew::io {

/// Binary, little-endian: positions in the shape's type and the file's coordinates, attributes in their order, faces.
std::vector<std::byte> new_ply(const Shape& shape, WriteReport& report);

/// `attribute` with one value a point, if every one of the n points has just one; else nothing (count() == 0).
Attribute one_a_point(const Attribute& attribute, std::size_t n);

}  // namespace sinew::io
