#pragma once
/// Image: a two-dimensional picture on the device, and copies of it to and from buffers.

#include "engine/gpu/buffer.h"
#include "engine/gpu/frame.h"

namespace sinew::gpu {

struct Image {
  Owned<VkDeviceMemory> memory;
  Owned<VkImage> handle;
  Owned<VkImageView> view;
  VkFormat format = VK_FORMAT_UNDEFINED;
  VkExtent2D extent{0, 0};
};

bool has_depth(VkFormat format);

/// `samples` 1 or 4. Contents and layout are undefined. InputError where a side is 0 or above the device's limit.
Image create_image(const Device& device, VkExtent2D extent, VkFormat format, VkSampleCountFlagBits samples,
                   VkImageUsageFlags usage);

/// Waits for `from`, changes the layout, lets `to` go on.
void image_barrier(VkCommandBuffer commands, VkImage image, VkFormat format, Access from, VkImageLayout old_layout,
                   Access to, VkImageLayout new_layout);

/// The rectangle, row by row without gaps, from or to the buffer's `offset`. The image is in the transfer layout.
void copy_to_buffer(VkCommandBuffer commands, const Image& image, VkRect2D rectangle, const Buffer& buffer);
void copy_from_buffer(VkCommandBuffer commands, const Buffer& buffer, std::size_t offset, VkImage image,
                      VkFormat format, VkExtent2D extent);

}  // namespace sinew::gpu
