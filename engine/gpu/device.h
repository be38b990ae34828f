#pragma once
/// Device: the Vulkan 1.3 instance, the chosen GPU (or software driver), its one queue and what it can do.

#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "engine/gpu/vulkan.h"

namespace sinew::gpu {

struct DeviceOptions {
  /// The layer VK_LAYER_KHRONOS_validation with synchronization validation; its messages are collected. InputError
  /// where it is not installed. (Hazards between submits need the environment's
  /// VK_LAYER_ENABLES=VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT as well.)
  bool validation = false;
  /// For a window: the instance extensions its library asks for, and a function that makes the surface, which the
  /// device then owns. Left empty: headless.
  std::vector<const char*> instance_extensions;
  std::function<VkSurfaceKHR(VkInstance)> create_surface;
};

/// What the validation layer said. It may be read after the device is gone (leaks are told at its end).
struct Messages {
  std::vector<std::string> take();  ///< all so far, which are then forgotten
  void add(std::string text);

 private:
  std::mutex mutex_;
  std::vector<std::string> texts_;
};

struct Pipeline;

struct Device {
  VkInstance instance = VK_NULL_HANDLE;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  VkSurfaceKHR surface = VK_NULL_HANDLE;  ///< null: headless
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice handle = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;  ///< graphics, compute, transfer and, with a surface, present
  std::uint32_t queue_family = 0;
  std::string name;       ///< as the driver says it: "llvmpipe (LLVM 15.0.6, 256 bits)"
  bool software = false;  ///< the device is the processor: its memory is ordinary memory, and it is slow at points
  VkPhysicalDeviceLimits limits{};
  VkPhysicalDeviceMemoryProperties memory{};
  std::shared_ptr<Pipeline> skin_pipeline;  ///< of skin.comp
  std::shared_ptr<Messages> messages = std::make_shared<Messages>();

  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  ~Device();
};

/// A real GPU is taken before a software one; of those, the one whose name contains the environment's
/// SINEW_VULKAN_DEVICE, if that is set. InputError where there is none, saying what to install.
std::unique_ptr<Device> create_device(const DeviceOptions& options);

void wait_idle(const Device& device);

}  // namespace sinew::gpu
