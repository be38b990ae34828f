#include "engine/gpu/swapchain.h"

#include <algorithm>

#include "engine/geometry/check.h"
#include "engine/geometry/error.h"

namespace sinew::gpu {
namespace {

Owned<VkSemaphore> create_semaphore(const Device& device) {
  const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  VkSemaphore semaphore = VK_NULL_HANDLE;
  vk_check(vkCreateSemaphore(device.handle, &info, nullptr, &semaphore), "vkCreateSemaphore");
  return {device.handle, semaphore, vkDestroySemaphore};
}

VkSurfaceFormatKHR choose_format(const Device& device) {
  std::uint32_t count = 0;
  vk_check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, device.surface, &count, nullptr),
           "vkGetPhysicalDeviceSurfaceFormatsKHR");
  std::vector<VkSurfaceFormatKHR> formats(count);
  vk_check(vkGetPhysicalDeviceSurfaceFormatsKHR(device.physical, device.surface, &count, formats.data()),
           "vkGetPhysicalDeviceSurfaceFormatsKHR");
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
    for (const VkSurfaceFormatKHR& format : formats)
      if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) return format;
  throw file_error("window", "a surface of 8 bits a channel", std::to_string(count) + " other formats");
}

/// Mailbox shows the newest picture without tearing and without waiting; fifo is always there.
VkPresentModeKHR choose_mode(const Device& device) {
  std::uint32_t count = 0;
  vk_check(vkGetPhysicalDeviceSurfacePresentModesKHR(device.physical, device.surface, &count, nullptr),
           "vkGetPhysicalDeviceSurfacePresentModesKHR");
  std::vector<VkPresentModeKHR> modes(count);
  vk_check(vkGetPhysicalDeviceSurfacePresentModesKHR(device.physical, device.surface, &count, modes.data()),
           "vkGetPhysicalDeviceSurfacePresentModesKHR");
  const bool mailbox = std::ranges::find(modes, VK_PRESENT_MODE_MAILBOX_KHR) != modes.end();
  return mailbox ? VK_PRESENT_MODE_MAILBOX_KHR : VK_PRESENT_MODE_FIFO_KHR;
}

void create_entry(const Device& device, const Swapchain& swapchain, Swapchain::Entry& entry) {
  VkImageViewCreateInfo view_info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view_info.image = entry.image;
  view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view_info.format = swapchain.format;
  view_info.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  VkImageView view = VK_NULL_HANDLE;
  vk_check(vkCreateImageView(device.handle, &view_info, nullptr, &view), "vkCreateImageView");
  entry.view = {device.handle, view, vkDestroyImageView};

  VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  info.renderPass = swapchain.cover;
  info.attachmentCount = 1;
  info.pAttachments = &view;
  info.width = swapchain.extent.width;
  info.height = swapchain.extent.height;
  info.layers = 1;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  vk_check(vkCreateFramebuffer(device.handle, &info, nullptr, &framebuffer), "vkCreateFramebuffer");
  entry.framebuffer = {device.handle, framebuffer, vkDestroyFramebuffer};
  entry.drawn = create_semaphore(device);
}

VkExtent2D choose_extent(const VkSurfaceCapabilitiesKHR& surface, VkExtent2D wanted) {
  if (surface.currentExtent.width != 0xffffffffu) return surface.currentExtent;
  return {std::clamp(wanted.width, surface.minImageExtent.width, surface.maxImageExtent.width),
          std::clamp(wanted.height, surface.minImageExtent.height, surface.maxImageExtent.height)};
}

/// False where the window has no area.
bool create_images(const Device& device, Swapchain& swapchain, VkExtent2D window_size) {
  wait_idle(device);
  VkSurfaceCapabilitiesKHR surface{};
  vk_check(vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device.physical, device.surface, &surface),
           "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
  const VkExtent2D extent = choose_extent(surface, window_size);
  if (extent.width == 0 || extent.height == 0) return false;

  VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
  info.surface = device.surface;
  info.minImageCount = std::max(surface.minImageCount, 3u);
  if (surface.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, surface.maxImageCount);
  info.imageFormat = swapchain.format;
  info.imageColorSpace = swapchain.color_space;
  info.imageExtent = extent;
  info.imageArrayLayers = 1;
  info.imageUsage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  info.preTransform = surface.currentTransform;
  info.compositeAlpha = (surface.supportedCompositeAlpha & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) != 0
                            ? VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR
                            : VK_COMPOSITE_ALPHA_INHERIT_BIT_KHR;
  info.presentMode = swapchain.mode;
  info.clipped = VK_TRUE;
  info.oldSwapchain = swapchain.handle;
  swapchain.images.clear();
  VkSwapchainKHR handle = VK_NULL_HANDLE;
  vk_check(vkCreateSwapchainKHR(device.handle, &info, nullptr, &handle), "vkCreateSwapchainKHR");
  swapchain.handle = {device.handle, handle, vkDestroySwapchainKHR};
  swapchain.extent = extent;

  std::uint32_t count = 0;
  vk_check(vkGetSwapchainImagesKHR(device.handle, handle, &count, nullptr), "vkGetSwapchainImagesKHR");
  std::vector<VkImage> images(count);
  vk_check(vkGetSwapchainImagesKHR(device.handle, handle, &count, images.data()), "vkGetSwapchainImagesKHR");
  swapchain.images.resize(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    swapchain.images[i].image = images[i];
    create_entry(device, swapchain, swapchain.images[i]);
  }
  // One that was signalled by an image never drawn can't be waited for any more.
  swapchain.acquired = create_semaphore(device);
  swapchain.stale = false;
  return true;
}

}  // namespace

Swapchain create_swapchain(const Device& device) {
  CHECK(device.surface != VK_NULL_HANDLE);
  Swapchain swapchain;
  const VkSurfaceFormatKHR format = choose_format(device);
  swapchain.format = format.format;
  swapchain.color_space = format.colorSpace;
  swapchain.mode = choose_mode(device);
  swapchain.cover = create_final_pass(device, swapchain.format, Start::Cover, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
  swapchain.keep = create_final_pass(device, swapchain.format, Start::Keep, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR);
  return swapchain;
}

bool acquire(const Device& device, Swapchain& swapchain, VkExtent2D window_size) {
  if (window_size.width == 0 || window_size.height == 0) return false;
  const bool resized = swapchain.extent.width != window_size.width || swapchain.extent.height != window_size.height;
  if ((swapchain.stale || resized) && !create_images(device, swapchain, window_size)) return false;
  const VkResult result = vkAcquireNextImageKHR(device.handle, swapchain.handle, UINT64_MAX, swapchain.acquired,
                                                VK_NULL_HANDLE, &swapchain.current);
  if (result == VK_ERROR_OUT_OF_DATE_KHR) {
    swapchain.stale = true;
    return false;
  }
  if (result == VK_SUBOPTIMAL_KHR) swapchain.stale = true;
  vk_check(result, "vkAcquireNextImageKHR");
  return true;
}

FinalTarget final_target(const Swapchain& swapchain) {
  const Swapchain::Entry& entry = swapchain.images[swapchain.current];
  return {swapchain.extent, swapchain.format, entry.image, entry.framebuffer, swapchain.cover, swapchain.keep};
}

VkSemaphore acquired(const Swapchain& swapchain) {
  return swapchain.acquired;
}

VkSemaphore drawn(const Swapchain& swapchain) {
  return swapchain.images[swapchain.current].drawn;
}

void present(const Device& device, Swapchain& swapchain) {
  VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = swapchain.images[swapchain.current].drawn.address();
  info.swapchainCount = 1;
  info.pSwapchains = swapchain.handle.address();
  info.pImageIndices = &swapchain.current;
  const VkResult result = vkQueuePresentKHR(device.queue, &info);
  if (result == VK_ERROR_OUT_OF_DATE_KHR || result == VK_SUBOPTIMAL_KHR) {
    swapchain.stale = true;
    return;
  }
  vk_check(result, "vkQueuePresentKHR");
}

}  // namespace sinew::gpu
