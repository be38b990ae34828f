#pragma once
/// Scan sets: a .conf file names scans and the pose of each, as Stanford's do. Opens as one shape in the world, with a
/// Part for each scan, and goes back to one file a scan, each in its own frame.
///
/// A line is `bmesh FILE tx ty tz qi qj qk qr` (or `mesh`); p_world = R^T p_own + t, where R is the usual rotation of
/// the quaternion (qi, qj, qk, qr), vector first, after it was given the length 1. Other lines are kept. Scans that are
/// not there are counted in Shape::notes; that none is there is an InputError.
///
/// Attributes that all scans have with one type become attributes of the set; normals, vectors and points are turned
/// into the world with the positions. Others are kept in their own files and noted, and so are those of splats.

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "engine/io/io.h"

namespace sinew::io {

Shape read_scan_set(const std::string& path, std::vector<std::byte> bytes, const ReadOptions& options);

/// The scans, each in its own frame and format, and last the .conf, named `conf_name` or, where that is empty, as it
/// was read. A point that is where it was in the world has the bits of its file. A scan whose path leads out of the
/// folder is named by its last part. Throws InputError where the shape has no parts or two would have one name.
std::vector<NamedBytes> scan_set_files(const Shape& shape, const std::string& conf_name, WriteReport& report);

}  // namespace sinew::io
