#pragma once
/// Pick: what is seen in a rectangle of a picture: the front-most point or face of each pixel, and its depth. Drawn
/// only when asked for: by the device into an image of ids, or by the CPU (raster.h); both give the same.

#include <cstdint>
#include <vector>

#include "engine/gpu/renderer.h"

namespace sinew::gpu {

/// Ids count from 1 through the scene's solid clouds, then its solid meshes, in their order: an item's points or faces.
struct PickRange {
  bool mesh = false;  ///< ids are faces of scene.meshes[item]; otherwise points of scene.clouds[item]
  std::size_t item = 0;
  std::uint32_t first_id = 1, count = 0;
};
std::vector<PickRange> pick_ranges(const Scene& scene);

struct PickResult {
  VkRect2D rectangle{};            ///< that was asked for, cut to the picture
  std::vector<std::uint32_t> ids;  ///< row by row; 0: nothing
  std::vector<float> depths;       ///< of the picture (unproject in camera.h); 0: nothing

  std::size_t index(std::uint32_t x, std::uint32_t y) const {  ///< of pixel (x, y) of the rectangle
    return std::size_t{y} * rectangle.extent.width + x;
  }
};

/// The id's item and its point or face; false for 0.
bool pick_element(std::span<const PickRange> ranges, std::uint32_t id, PickRange& range, std::uint32_t& element);

struct Picker;
struct DestroyPicker {
  void operator()(Picker* picker) const;
};
using PickerHandle = std::unique_ptr<Picker, DestroyPicker>;
PickerHandle create_picker(const Device& device, const Paths& paths);

/// Runs at once and waits; no picture may be in flight (call finish or begin_frame before). `rectangle` may reach
/// beyond the picture of size `extent`.
PickResult pick(const Device& device, Picker& picker, const Scene& scene, VkExtent2D extent, VkRect2D rectangle);

}  // namespace sinew::gpu
