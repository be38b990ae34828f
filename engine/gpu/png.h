#pragma once
/// PNG files, by libpng, which is seen in png.cpp only.

#include <string>

#include "engine/gpu/offscreen.h"

namespace sinew::gpu {

/// Written beside the path under another name first, then renamed: the file is whole or is not there. InputError.
void write_png(const std::string& path, const Picture& picture);

/// Any PNG as RGBA8, with sides up to 16,384. InputError where it is none.
Picture read_png(const std::string& path);

}  // namespace sinew::gpu
