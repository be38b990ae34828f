#include "engine/gpu/image.h"

#include <string>

#include "engine/geometry/error.h"

namespace sinew::gpu {
namespace {

VkImageAspectFlags aspect_of(VkFormat format) {
  return has_depth(format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
}

}  // namespace

bool has_depth(VkFormat format) {
  return format == VK_FORMAT_D32_SFLOAT;
}

Image create_image(const Device& device, VkExtent2D extent, VkFormat format, VkSampleCountFlagBits samples,
                   VkImageUsageFlags usage) {
  const std::uint32_t limit = device.limits.maxImageDimension2D;
  if (extent.width == 0 || extent.height == 0 || extent.width > limit || extent.height > limit)
    throw file_error("picture", "a width and height from 1 to " + std::to_string(limit),
                     std::to_string(extent.width) + "x" + std::to_string(extent.height));
  Image image;
  image.format = format;
  image.extent = extent;
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = format;
  info.extent = {extent.width, extent.height, 1};
  info.mipLevels = 1;
  info.arrayLayers = 1;
  info.samples = samples;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = usage;
  VkImage handle = VK_NULL_HANDLE;
  vk_check(vkCreateImage(device.handle, &info, nullptr, &handle), "vkCreateImage");
  image.handle = {device.handle, handle, vkDestroyImage};

  VkMemoryRequirements needed{};
  vkGetImageMemoryRequirements(device.handle, handle, &needed);
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.allocationSize = needed.size;
  allocate.memoryTypeIndex = memory_type(device, needed.memoryTypeBits, VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT, 0);
  VkDeviceMemory memory = VK_NULL_HANDLE;
  vk_check(vkAllocateMemory(device.handle, &allocate, nullptr, &memory), "vkAllocateMemory");
  image.memory = {device.handle, memory, vkFreeMemory};
  vk_check(vkBindImageMemory(device.handle, handle, memory, 0), "vkBindImageMemory");

  VkImageViewCreateInfo view_info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  view_info.image = handle;
  view_info.viewType = VK_IMAGE_VIEW_TYPE_2D;
  view_info.format = format;
  view_info.subresourceRange = {aspect_of(format), 0, 1, 0, 1};
  VkImageView view = VK_NULL_HANDLE;
  vk_check(vkCreateImageView(device.handle, &view_info, nullptr, &view), "vkCreateImageView");
  image.view = {device.handle, view, vkDestroyImageView};
  return image;
}

void image_barrier(VkCommandBuffer commands, VkImage image, VkFormat format, Access from, VkImageLayout old_layout,
                   Access to, VkImageLayout new_layout) {
  VkImageMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  barrier.srcStageMask = from.stage;
  barrier.srcAccessMask = from.access;
  barrier.dstStageMask = to.stage;
  barrier.dstAccessMask = to.access;
  barrier.oldLayout = old_layout;
  barrier.newLayout = new_layout;
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  barrier.image = image;
  barrier.subresourceRange = {aspect_of(format), 0, 1, 0, 1};
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
}

void copy_to_buffer(VkCommandBuffer commands, const Image& image, VkRect2D rectangle, const Buffer& buffer) {
  VkBufferImageCopy region{};
  region.imageSubresource = {aspect_of(image.format), 0, 0, 1};
  region.imageOffset = {rectangle.offset.x, rectangle.offset.y, 0};
  region.imageExtent = {rectangle.extent.width, rectangle.extent.height, 1};
  vkCmdCopyImageToBuffer(commands, image.handle, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, buffer.handle, 1, &region);
}

void copy_from_buffer(VkCommandBuffer commands, const Buffer& buffer, std::size_t offset, VkImage image,
                      VkFormat format, VkExtent2D extent) {
  VkBufferImageCopy region{};
  region.bufferOffset = offset;
  region.imageSubresource = {aspect_of(format), 0, 0, 1};
  region.imageExtent = {extent.width, extent.height, 1};
  vkCmdCopyBufferToImage(commands, buffer.handle, image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

}  // namespace sinew::gpu
