#pragma once
/// Gaussian splats, drawn by the CPU as splat.frag does it.

#include "engine/gpu/raster.h"

namespace sinew::gpu {

/// Blends the scene's splats, the farthest first, over a finished picture; what `out` has before them hides them.
void raster_splats(const Scene& scene, VkExtent2D extent, const RasterOutput& out);

}  // namespace sinew::gpu
