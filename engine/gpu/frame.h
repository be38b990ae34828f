#pragma once
/// Frame: the command buffers of one picture, one a pass, and the fence that says when it is done. One picture is in
/// flight: from begin_frame() to submit() nothing runs on the device, so mapped buffers may be written.

#include <functional>
#include <vector>

#include "engine/gpu/device.h"

namespace sinew::gpu {

struct Frame {
  Owned<VkCommandPool> pool;
  std::vector<VkCommandBuffer> passes;  ///< of the pool; the first `used` belong to this picture
  std::size_t used = 0;
  Owned<VkFence> fence;
  bool pending = false;  ///< submitted, not yet waited for
};

Frame create_frame(const Device& device);

void begin_frame(const Device& device, Frame& frame);  ///< waits for the picture before
VkCommandBuffer begin_pass(const Device& device, Frame& frame);
void end_pass(const Device& device, Frame& frame);

/// Runs the passes. `wait` (at the colour output and transfer stages) and `signal` may be null.
void submit(const Device& device, Frame& frame, VkSemaphore wait, VkSemaphore signal);
void finish(const Device& device, Frame& frame);  ///< waits until submitted passes are done; Frame may be destroyed

/// Records, runs and waits for one pass.
void run_once(const Device& device, const std::function<void(VkCommandBuffer)>& record);

/// All memory written by `from` is seen by `to`.
struct Access {
  VkPipelineStageFlags2 stage;
  VkAccessFlags2 access;
};
void memory_barrier(VkCommandBuffer commands, Access from, Access to);

}  // namespace sinew::gpu
