#pragma once
/// What every file of this folder needs of Vulkan: owned handles and checked results.

#include <vulkan/vulkan.h>

#include <utility>

namespace sinew::gpu {

/// Throws InputError, naming the call, where a result is an error of the environment (no memory, device lost).
void vk_check(VkResult result, const char* call);

/// A handle that belongs to a device and is destroyed with its owner. The device must outlive it.
template <class T>
class Owned {
 public:
  using Destroy = void (*)(VkDevice, T, const VkAllocationCallbacks*);

  Owned() = default;
  Owned(VkDevice device, T handle, Destroy destroy) : device_(device), handle_(handle), destroy_(destroy) {}
  Owned(Owned&& other) noexcept { swap(other); }
  Owned& operator=(Owned&& other) noexcept {
    Owned(std::move(other)).swap(*this);
    return *this;
  }
  ~Owned() {
    if (handle_ != VK_NULL_HANDLE) destroy_(device_, handle_, nullptr);
  }

  operator T() const { return handle_; }
  const T* address() const { return &handle_; }
  void swap(Owned& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    std::swap(destroy_, other.destroy_);
  }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  T handle_ = VK_NULL_HANDLE;
  Destroy destroy_ = nullptr;
};

}  // namespace sinew::gpu
