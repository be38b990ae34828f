#pragma once
/// What the columns of an XYZ or CSV file mean by their names (xyz.h has the list).

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "engine/geometry/attribute.h"

namespace sinew::io {

inline constexpr std::size_t most_xyz_columns = 256;

/// Some columns that are one attribute.
struct XyzGroup {
  std::string name;
  Kind kind = Kind::Scalar;
  std::vector<std::size_t> columns;
};

std::string xyz_lower(std::string_view text);
bool has_xyz_group(const std::vector<XyzGroup>& groups, const std::string& name);

/// The names in a line, two ways: where blanks stand between them too, and where only separators do ("my speed, x").
std::vector<std::vector<std::string>> split_xyz_names(std::string_view line);
/// A line is one of names where x, y and z are among them.
bool has_xyz_position(const std::vector<std::string>& names);
/// The groups of columns of these names; the first is the position.
std::vector<XyzGroup> xyz_groups(const std::vector<std::string>& names);

}  // namespace sinew::io
