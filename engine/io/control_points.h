#pragma once
/// Control points: a CSV of points of a shape, or places on it, and where each of them is to be.
///
/// A row a point; cells are parted by commas, or where the first row has none by semicolons or tabs; empty rows and
/// those that begin with # are left out. The first row may name the columns, in any order: tx, ty, tz (or target_x ...)
/// the target; x, y, z the place, or id (index, point) the number of the point, from 0; name (label) what to call it,
/// for which the id serves where there are places. Other columns are not read. Without names the columns are
///
///   id, tx, ty, tz      x, y, z, tx, ty, tz      name, x, y, z, tx, ty, tz

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/geometry/shape.h"

namespace sinew::io {

struct ControlPoint {
  std::string name;            ///< or empty
  std::optional<Index> point;  ///< its number; without, `at` is its place
  Vec3 at = Vec3::Zero();
  Vec3 to = Vec3::Zero();  ///< as `at` in the shape's coordinates, without an origin taken off
};

/// At least one. Throws InputError with the line and column: a cell that is no finite number, a row with other columns.
std::vector<ControlPoint> read_control_points(const std::string& path);
/// The same of the bytes of a file; `path` is only for messages.
std::vector<ControlPoint> read_control_points(const std::string& path, std::span<const std::byte> bytes);

/// Whether the first row of a .csv file names targets. False where it can't be read. A file without names could be a
/// cloud of points with colours or normals as well, and is not taken for control points by itself.
bool is_control_points(const std::string& path);

}  // namespace sinew::io
