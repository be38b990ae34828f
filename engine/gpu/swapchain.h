#pragma once
/// Swapchain: the images of a window. A picture is drawn so:
///
///   begin_frame(device, frame);
///   if (!acquire(device, swapchain, window_size)) continue;    // minimised, or not yet: try again later
///   commands = begin_picture(device, renderer, frame, scene, final_target(swapchain));
///   ... user interface, in final_target(swapchain).cover's kind of render pass ...
///   end_picture(device, frame, commands);
///   submit(device, frame, acquired(swapchain), drawn(swapchain));
///   present(device, swapchain);

#include <vector>

#include "engine/gpu/renderer.h"

namespace sinew::gpu {

struct Swapchain {
  Owned<VkSwapchainKHR> handle;
  VkFormat format = VK_FORMAT_UNDEFINED;  ///< fixed when it is created: the renderer and its pipelines rely on it
  VkColorSpaceKHR color_space = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
  VkPresentModeKHR mode = VK_PRESENT_MODE_FIFO_KHR;
  VkExtent2D extent{0, 0};
  Owned<VkRenderPass> cover, keep;
  struct Entry {
    VkImage image = VK_NULL_HANDLE;
    Owned<VkImageView> view;
    Owned<VkFramebuffer> framebuffer;
    Owned<VkSemaphore> drawn;  ///< waited for by the presentation of this image
  };
  std::vector<Entry> images;
  Owned<VkSemaphore> acquired;
  std::uint32_t current = 0;
  bool stale = true;  ///< the window has another size, or asks for new images

  std::uint32_t image_count() const { return static_cast<std::uint32_t>(images.size()); }
};

/// The device has a surface. InputError where it has no format of 8 bits a channel that is not converted from linear.
/// Images come with the first acquire.
Swapchain create_swapchain(const Device& device);

/// The next image to draw into; makes new images where the size changed (waiting until the device is idle). False where
/// there is nothing to draw into: a size of zero, or a surface that has changed again already.
bool acquire(const Device& device, Swapchain& swapchain, VkExtent2D window_size);

FinalTarget final_target(const Swapchain& swapchain);
VkSemaphore acquired(const Swapchain& swapchain);
VkSemaphore drawn(const Swapchain& swapchain);

/// Shows the image; a surface that has changed is noted for the next acquire.
void present(const Device& device, Swapchain& swapchain);

}  // namespace sinew::gpu
