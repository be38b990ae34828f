#pragma once
/// C3D: markers of motion capture as 16-bit integers or floats of three processors (www.c3d.org).
///
/// Blocks of 512 bytes: a header, parameters, frames. A frame has four numbers a point (x, y, z, residual) and then the
/// analog samples. A negative residual means that the point was not seen. The sign of POINT:SCALE tells the numbers'
/// type: negative, floats as they are; positive, integers times the scale.
///
/// The parameters' word goes before the header's, and that of TRIAL:ACTUAL_START_FIELD and ACTUAL_END_FIELD or
/// POINT:LONG_FRAMES before the header's 16 bits of frames; where what they say does not fit the file and another word
/// does, that one counts. Whatever disagrees is noted.

#include "engine/io/motion.h"

namespace sinew::io {

/// Throws InputError: no C3D file, cut short, no points, no frames.
Trajectories read_c3d(const std::string& path, std::span<const std::byte> bytes);

}  // namespace sinew::io
