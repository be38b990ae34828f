#pragma once
/// Raster: points and triangles drawn by the CPU, for devices that are the CPU themselves (a software driver takes
/// about a microsecond a point and ten milliseconds for any shader over the whole picture; this takes a twentieth of
/// that). The picture is the one that the shaders make, pixel for pixel but for rounding; ids come with it.
///
/// A pixel keeps the nearest thing as one number: depth bits above, complement of the id below; of equally near things
/// the lowest id wins, so that threads do not change a bit.

#include <cstdint>
#include <span>
#include <vector>

#include "engine/gpu/scene.h"
#include "shaders/shared.h"

namespace sinew::gpu {

/// One item of a scene. Ids: first_id + point or face.
struct RasterItem {
  const Points* points = nullptr;
  const Triangles* triangles = nullptr;  ///< null: a cloud
  bool rest = false;
  std::size_t count = 0;  ///< points of a cloud that are drawn: the first of its order
  std::uint32_t first_id = 1;
  shared::DrawConstants constants;  ///< as the shaders get them
  /// Pixel position and depth of each point (of a cloud: of each drawn one); depth 0: not seen.
  std::vector<Eigen::Vector3f> projected;
};

struct RasterImage {
  int width = 0, height = 0;
  std::vector<std::uint64_t> keys;  ///< 0: nothing

  std::uint32_t id(std::size_t pixel) const { return ~static_cast<std::uint32_t>(keys[pixel]); }
  bool empty(std::size_t pixel) const { return keys[pixel] == 0; }
  float depth(std::size_t pixel) const;
};

/// The drawn items of the scene (ghosts or the others), clouds first; ids count from 1 in this order. `scale`: pixels
/// of the raster a pixel of the picture. All buffers must be mapped.
std::vector<RasterItem> raster_items(const Scene& scene, VkExtent2D extent, bool ghosts, int scale);

/// Whether the CPU can read what the scene shows.
bool can_raster(const Scene& scene);

/// Projects the items and draws them into an image of this size, which is cleared first.
void raster(RasterImage& image, int width, int height, std::span<RasterItem> items);

/// Where the finished picture goes.
struct RasterOutput {
  std::uint32_t* colors = nullptr;  ///< width x height, 4 bytes each
  float* depths = nullptr;          ///< width x height
  bool blue_first = false;          ///< B8G8R8A8; otherwise R8G8B8A8
};

/// Columns [begin, end) of a row.
struct RasterSpan {
  int begin = 0, end = 0;
};

/// Memory that shading needs and that is worth keeping from picture to picture.
struct RasterScratch {
  RasterImage solid, ghost;
  std::vector<float> depths;          ///< padded
  std::vector<std::uint32_t> colors;  ///< of the raster, where it is finer than the picture
  std::vector<RasterSpan> covered;    ///< of each row
  std::vector<std::uint8_t> selected;
};

/// The whole picture: backdrop, shapes under their light, eye-dome lighting, outline of what is selected, ghosts,
/// splats. With scene.smooth_edges two by two samples a pixel (up to a limit of memory).
void raster_scene(RasterScratch& scratch, const Scene& scene, VkExtent2D extent, const RasterOutput& out);

}  // namespace sinew::gpu
