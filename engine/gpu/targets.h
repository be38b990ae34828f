#pragma once
/// Targets: the images that shapes are drawn into, and the render passes that do it. Afterwards `color` and `depth`,
/// one sample a pixel, are in the layouts that shaders read.

#include "engine/gpu/image.h"

namespace sinew::gpu {

inline constexpr VkFormat color_format = VK_FORMAT_R8G8B8A8_UNORM;  ///< alpha: 1 where what is seen is selected
inline constexpr VkFormat depth_format = VK_FORMAT_D32_SFLOAT;      ///< reversed; 0: nothing there
inline constexpr VkImageLayout color_layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
inline constexpr VkImageLayout depth_layout = VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL;

/// Begins with depth 0 and undefined colours. With four samples, colour (average) and depth (first sample) are resolved
/// at the end.
Owned<VkRenderPass> create_shape_pass(const Device& device, VkSampleCountFlagBits samples);

struct Targets {
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  VkExtent2D extent{0, 0};
  Image color, depth;
  Image sample_color, sample_depth;  ///< of four samples; or none
  Owned<VkFramebuffer> framebuffer;
};
Targets create_targets(const Device& device, VkExtent2D extent, VkSampleCountFlagBits samples, VkRenderPass pass);

void begin_shape_pass(VkCommandBuffer commands, VkRenderPass pass, const Targets& targets);

}  // namespace sinew::gpu
