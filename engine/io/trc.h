#pragma once
/// TRC (Track Row Column): markers in text with tabs between. Five lines of a header (the kind of file, names of
/// properties, their values, names of markers over every third column, names of columns) and a row a frame: number,
/// time, x, y and z of each marker, empty where it was not seen.

#include "engine/io/motion.h"

namespace sinew::io {

/// Throws InputError. Counts are those of names and rows; where the header's differ, that is noted.
Trajectories read_trc(const std::string& path, std::span<const std::byte> bytes);

}  // namespace sinew::io
