#pragma once
/// CSV of markers: a row of names and a row a frame. Columns are NAME.x, NAME.y and NAME.z (or with _ or : for the dot,
/// or capitals), and may be those of the frame's number ("frame", "frame#") and its time in seconds ("time",
/// "time (s)", "time_s", "t"). An empty cell means that the marker was not seen. Cells are parted by commas, or where
/// the first row has none by semicolons or tabs.

#include "engine/io/io.h"
#include "engine/io/motion.h"

namespace sinew::io {

/// Throws InputError. Other columns are named in a note.
Trajectories read_marker_csv(const std::string& path, std::span<const std::byte> bytes);

/// Whether a first row has columns of markers, of the frame or time, and none else.
bool names_markers(std::string_view row);

/// "frame", "time" where there is a rate, and NAME.x, NAME.y, NAME.z; numbers that read back as the same.
std::vector<std::byte> write_marker_csv(const Trajectories& motion, WriteReport& report);

}  // namespace sinew::io
