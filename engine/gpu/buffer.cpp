#include "engine/gpu/buffer.h"

#include <algorithm>
#include <bit>
#include <cstring>

#include "engine/geometry/error.h"
#include "engine/gpu/frame.h"

namespace sinew::gpu {

std::uint32_t memory_type(const Device& device, std::uint32_t types, VkMemoryPropertyFlags wanted,
                          VkMemoryPropertyFlags preferred) {
  for (const VkMemoryPropertyFlags flags : {wanted | preferred, wanted})
    for (std::uint32_t i = 0; i < device.memory.memoryTypeCount; ++i)
      if ((types >> i & 1) != 0 && (device.memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
  throw file_error("Vulkan", "memory that this program can use", "none");
}

Buffer create_buffer(const Device& device, std::size_t size, Memory memory) {
  Buffer buffer;
  buffer.size = std::max<std::size_t>(size, 16);
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = buffer.size;
  info.usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_SHADER_DEVICE_ADDRESS_BIT |
               VK_BUFFER_USAGE_VERTEX_BUFFER_BIT | VK_BUFFER_USAGE_INDEX_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT |
               VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  VkBuffer handle = VK_NULL_HANDLE;
  vk_check(vkCreateBuffer(device.handle, &info, nullptr, &handle), "vkCreateBuffer");
  buffer.handle = {device.handle, handle, vkDestroyBuffer};

  VkMemoryRequirements needed{};
  vkGetBufferMemoryRequirements(device.handle, handle, &needed);
  VkMemoryPropertyFlags wanted = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  VkMemoryPropertyFlags preferred = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  if (memory == Memory::Device) wanted = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  if (memory == Memory::Readback) preferred = VK_MEMORY_PROPERTY_HOST_CACHED_BIT;

  VkMemoryAllocateFlagsInfo flags{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_FLAGS_INFO};
  flags.flags = VK_MEMORY_ALLOCATE_DEVICE_ADDRESS_BIT;
  VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO};
  allocate.pNext = &flags;
  allocate.allocationSize = needed.size;
  allocate.memoryTypeIndex = memory_type(device, needed.memoryTypeBits, wanted, preferred);
  VkDeviceMemory allocated = VK_NULL_HANDLE;
  vk_check(vkAllocateMemory(device.handle, &allocate, nullptr, &allocated), "vkAllocateMemory");
  buffer.memory = {device.handle, allocated, vkFreeMemory};
  vk_check(vkBindBufferMemory(device.handle, handle, allocated, 0), "vkBindBufferMemory");
  if (memory != Memory::Device)
    vk_check(vkMapMemory(device.handle, allocated, 0, VK_WHOLE_SIZE, 0, &buffer.mapped), "vkMapMemory");

  VkBufferDeviceAddressInfo address{VK_STRUCTURE_TYPE_BUFFER_DEVICE_ADDRESS_INFO};
  address.buffer = handle;
  buffer.address = vkGetBufferDeviceAddress(device.handle, &address);
  return buffer;
}

Buffer upload(const Device& device, std::span<const std::byte> bytes) {
  Buffer buffer = create_buffer(device, bytes.size(), Memory::Device);
  if (bytes.empty()) return buffer;
  const Buffer staging = create_buffer(device, bytes.size(), Memory::Upload);
  std::memcpy(staging.mapped, bytes.data(), bytes.size());
  run_once(device, [&](VkCommandBuffer commands) {
    const VkBufferCopy region{0, 0, bytes.size()};
    vkCmdCopyBuffer(commands, staging.handle, buffer.handle, 1, &region);
  });
  return buffer;
}

void grow(const Device& device, Buffer& buffer, std::size_t size, Memory memory) {
  if (buffer.size >= size && buffer.handle != VK_NULL_HANDLE) return;
  buffer = {};
  buffer = create_buffer(device, std::bit_ceil(size), memory);
}

}  // namespace sinew::gpu
