#pragma once
/// Buffer: memory that shaders read and write by its address. One allocation each: there are few of them.

#include <cstddef>
#include <span>

#include "engine/gpu/device.h"

namespace sinew::gpu {

enum class Memory {
  Device,    ///< not seen by the CPU
  Upload,    ///< mapped, written by the CPU; on the device where it can be
  Readback,  ///< mapped, read by the CPU
};

struct Buffer {
  Owned<VkDeviceMemory> memory;
  Owned<VkBuffer> handle;
  std::size_t size = 0;  ///< bytes; 0: none
  VkDeviceAddress address = 0;
  void* mapped = nullptr;

  template <class T>
  std::span<T> as() const {
    return {static_cast<T*>(mapped), size / sizeof(T)};
  }
};

/// Every usage that this program has, so that a buffer can serve as vertices, indices, shader data and copies alike.
/// `size` 0 gives 16 bytes. Contents are undefined.
Buffer create_buffer(const Device& device, std::size_t size, Memory memory);

/// A Memory::Device buffer with these bytes; returns when they are there.
Buffer upload(const Device& device, std::span<const std::byte> bytes);

/// Replaces `buffer` by a larger one (contents lost) where it has fewer than `size` bytes. Not while the device uses
/// it.
void grow(const Device& device, Buffer& buffer, std::size_t size, Memory memory);

/// Index of a memory type with `wanted` flags among `types`, one with `preferred` too where there is one.
std::uint32_t memory_type(const Device& device, std::uint32_t types, VkMemoryPropertyFlags wanted,
                          VkMemoryPropertyFlags preferred);

}  // namespace sinew::gpu
