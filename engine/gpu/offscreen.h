#pragma once
/// Offscreen: a picture without a window, and one call that draws a scene into memory.

#include <cstdint>
#include <vector>

#include "engine/gpu/image.h"
#include "engine/gpu/renderer.h"

namespace sinew::gpu {

/// RGBA8, row by row from the top.
struct Picture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> rgba;

  const std::uint8_t* at(int x, int y) const {
    return rgba.data() +
           4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x));
  }
};

inline constexpr VkFormat offscreen_format = VK_FORMAT_R8G8B8A8_UNORM;

struct Offscreen {
  VkExtent2D extent{0, 0};
  Owned<VkRenderPass> cover, keep;
  Image image;
  Owned<VkFramebuffer> framebuffer;
  Buffer readback;
};

/// InputError where a side is 0 or above the device's limit (16,384 on most).
Offscreen create_offscreen(const Device& device, VkExtent2D extent);
FinalTarget final_target(const Offscreen& offscreen);

/// After end_picture, in a pass of its own: the picture goes to mapped memory; then submit, finish and read_picture.
void record_readback(VkCommandBuffer commands, const Offscreen& offscreen);
Picture read_picture(const Offscreen& offscreen);

/// All of it: records, runs, waits, reads. `renderer` is of offscreen_format.
Picture render_picture(const Device& device, Renderer& renderer, const Offscreen& offscreen, const Scene& scene);

}  // namespace sinew::gpu
