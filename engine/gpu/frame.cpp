#include "engine/gpu/frame.h"

#include "engine/geometry/check.h"

namespace sinew::gpu {

Frame create_frame(const Device& device) {
  Frame frame;
  VkCommandPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool_info.queueFamilyIndex = device.queue_family;
  VkCommandPool pool = VK_NULL_HANDLE;
  vk_check(vkCreateCommandPool(device.handle, &pool_info, nullptr, &pool), "vkCreateCommandPool");
  frame.pool = {device.handle, pool, vkDestroyCommandPool};

  const VkFenceCreateInfo fence_info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  VkFence fence = VK_NULL_HANDLE;
  vk_check(vkCreateFence(device.handle, &fence_info, nullptr, &fence), "vkCreateFence");
  frame.fence = {device.handle, fence, vkDestroyFence};
  return frame;
}

void begin_frame(const Device& device, Frame& frame) {
  finish(device, frame);
  vk_check(vkResetCommandPool(device.handle, frame.pool, 0), "vkResetCommandPool");
  frame.used = 0;
}

VkCommandBuffer begin_pass(const Device& device, Frame& frame) {
  CHECK(!frame.pending);
  if (frame.used == frame.passes.size()) {
    VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    info.commandPool = frame.pool;
    info.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    info.commandBufferCount = 1;
    VkCommandBuffer commands = VK_NULL_HANDLE;
    vk_check(vkAllocateCommandBuffers(device.handle, &info, &commands), "vkAllocateCommandBuffers");
    frame.passes.push_back(commands);
  }
  VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  vk_check(vkBeginCommandBuffer(frame.passes[frame.used], &begin), "vkBeginCommandBuffer");
  return frame.passes[frame.used];
}

void end_pass(const Device&, Frame& frame) {
  vk_check(vkEndCommandBuffer(frame.passes[frame.used]), "vkEndCommandBuffer");
  ++frame.used;
}

void submit(const Device& device, Frame& frame, VkSemaphore wait, VkSemaphore signal) {
  CHECK(!frame.pending);
  const VkPipelineStageFlags stages = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
  VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  info.commandBufferCount = static_cast<std::uint32_t>(frame.used);
  info.pCommandBuffers = frame.passes.data();
  info.waitSemaphoreCount = wait != VK_NULL_HANDLE ? 1 : 0;
  info.pWaitSemaphores = &wait;
  info.pWaitDstStageMask = &stages;
  info.signalSemaphoreCount = signal != VK_NULL_HANDLE ? 1 : 0;
  info.pSignalSemaphores = &signal;
  vk_check(vkResetFences(device.handle, 1, frame.fence.address()), "vkResetFences");
  vk_check(vkQueueSubmit(device.queue, 1, &info, frame.fence), "vkQueueSubmit");
  frame.pending = true;
}

void finish(const Device& device, Frame& frame) {
  if (!frame.pending) return;
  vk_check(vkWaitForFences(device.handle, 1, frame.fence.address(), VK_TRUE, UINT64_MAX), "vkWaitForFences");
  frame.pending = false;
}

void run_once(const Device& device, const std::function<void(VkCommandBuffer)>& record) {
  Frame frame = create_frame(device);
  record(begin_pass(device, frame));
  end_pass(device, frame);
  submit(device, frame, VK_NULL_HANDLE, VK_NULL_HANDLE);
  finish(device, frame);
}

void memory_barrier(VkCommandBuffer commands, Access from, Access to) {
  VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
  barrier.srcStageMask = from.stage;
  barrier.srcAccessMask = from.access;
  barrier.dstStageMask = to.stage;
  barrier.dstAccessMask = to.access;
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.memoryBarrierCount = 1;
  info.pMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace sinew::gpu
