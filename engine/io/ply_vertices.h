#pragma once
/// The points of a PLY file: which property is which coordinate or component of an attribute, and rows of a binary file
/// to points and back.

#include <cstddef>
#include <span>
#include <vector>

#include "engine/geometry/shape.h"
#include "engine/io/ply_header.h"

namespace sinew::io {

/// Where a property of the vertex element goes.
struct PlyColumn {
  static constexpr int unused = -1, position = -2;
  int attribute = unused;  ///< index into attributes; `position`; or `unused` (a list)
  int component = 0;       ///< of the attribute or position
  Type type = Type::Float32;
  std::size_t offset = 0;  ///< in a row of a binary file; meaningless behind a list
};

struct PlyVertices {
  std::vector<PlyColumn> columns;     ///< one a property, in the file's order
  std::vector<Attribute> attributes;  ///< without values
  Type position_type = Type::Float32;
  std::size_t stride = 0;  ///< bytes of a row of a binary file without lists
  bool swap = false;
  bool narrow = false;  ///< coordinates are text that is parsed as Float64, then rounded to float
};

PlyVertices layout_of(const PlyHeader& header);

/// Appends the points of whole binary rows (no lists) to `shape`, which has the layout's attributes: positions relative
/// to shape.origin.
void append_rows(const PlyVertices& layout, std::span<const std::byte> rows, Shape& shape);

/// Replaces what differs in points [first, first + rows / stride) of `shape` from what is in `rows`.
void patch_rows(const PlyVertices& layout, const Shape& shape, std::size_t first, std::span<std::byte> rows);

/// What kind of attribute the fields make that `names` names, if the format has a group of just these.
bool is_ply_group(const std::vector<std::string>& names, Kind kind);

}  // namespace sinew::io
