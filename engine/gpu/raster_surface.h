#pragma once
/// The colour of what a raster's pixel shows, under its light: what point.vert and mesh.frag do.

#include "engine/gpu/raster.h"

namespace sinew::gpu {

/// Red, green, blue from 0 to 1.
Eigen::Vector3f color_of(std::uint32_t rgba);

struct Shaded {
  Eigen::Vector3f color;
  bool selected = false;
  float alpha = 1;  ///< of a ghost
};

/// `pixel` is not empty; `items` are those that the image was drawn from.
Shaded shade(std::span<const RasterItem> items, const RasterImage& image, std::size_t pixel);

}  // namespace sinew::gpu
