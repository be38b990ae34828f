#pragma once
/// PNG files, by libpng, which is seen in png.cpp only.

#include <cstddef>
#include <string>
#include <vector>

#include "engine/gpu/offscreen.h"

namespace sinew::gpu {

/// The bytes of a PNG file, RGBA8. A picture has pixels.
std::vector<std::byte> png_bytes(const Picture& picture);

/// Any PNG as RGBA8, with sides up to 16,384. InputError where it is none.
Picture read_png(const std::string& path);

}  // namespace sinew::gpu
