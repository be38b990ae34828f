#include "engine/gpu/offscreen.h"

#include <cstring>

namespace sinew::gpu {

Offscreen create_offscreen(const Device& device, VkExtent2D extent) {
  Offscreen target;
  target.extent = extent;
  target.image = create_image(device, extent, offscreen_format, VK_SAMPLE_COUNT_1_BIT,
                              VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  target.readback = create_buffer(device, std::size_t{4} * extent.width * extent.height, Memory::Readback);
  target.pass = create_final_pass(device, offscreen_format, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  const VkImageView view = target.image.view;
  VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  info.renderPass = target.pass;
  info.attachmentCount = 1;
  info.pAttachments = &view;
  info.width = extent.width;
  info.height = extent.height;
  info.layers = 1;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  vk_check(vkCreateFramebuffer(device.handle, &info, nullptr, &framebuffer), "vkCreateFramebuffer");
  target.framebuffer = {device.handle, framebuffer, vkDestroyFramebuffer};
  return target;
}

void begin_target(VkCommandBuffer commands, const Offscreen& target) {
  VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  info.renderPass = target.pass;
  info.framebuffer = target.framebuffer;
  info.renderArea.extent = target.extent;
  vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
}

void record_readback(VkCommandBuffer commands, const Offscreen& target) {
  copy_to_buffer(commands, target.image, {{0, 0}, target.extent}, target.readback);
  memory_barrier(commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                 {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

Picture read_picture(const Offscreen& target) {
  Picture picture;
  picture.width = static_cast<int>(target.extent.width);
  picture.height = static_cast<int>(target.extent.height);
  const std::span<const std::uint8_t> bytes = target.readback.as<std::uint8_t>();
  picture.rgba.assign(bytes.begin(), bytes.end());
  return picture;
}

Picture render_picture(const Device& device, Renderer& renderer, const Offscreen& target, const Scene& scene) {
  Frame frame = create_frame(device);
  prepare_scene(device, renderer, frame, scene, target.extent);
  VkCommandBuffer commands = begin_pass(device, frame);
  begin_target(commands, target);
  compose_scene(renderer, commands, scene);
  vkCmdEndRenderPass(commands);
  end_pass(device, frame);
  record_readback(begin_pass(device, frame), target);
  end_pass(device, frame);
  submit(device, frame, VK_NULL_HANDLE, VK_NULL_HANDLE);
  finish(device, frame);
  return read_picture(target);
}

}  // namespace sinew::gpu
