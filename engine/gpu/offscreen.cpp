#include "engine/gpu/offscreen.h"

namespace sinew::gpu {

Offscreen create_offscreen(const Device& device, VkExtent2D extent) {
  Offscreen target;
  target.extent = extent;
  target.image = create_image(
      device, extent, offscreen_format, VK_SAMPLE_COUNT_1_BIT,
      VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  target.readback = create_buffer(device, std::size_t{4} * extent.width * extent.height, Memory::Readback);
  target.cover = create_final_pass(device, offscreen_format, Start::Cover, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  target.keep = create_final_pass(device, offscreen_format, Start::Keep, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  const VkImageView view = target.image.view;
  VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  info.renderPass = target.cover;
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

FinalTarget final_target(const Offscreen& offscreen) {
  return {offscreen.extent,      offscreen_format, offscreen.image.handle,
          offscreen.framebuffer, offscreen.cover,  offscreen.keep};
}

void record_readback(VkCommandBuffer commands, const Offscreen& offscreen) {
  copy_to_buffer(commands, offscreen.image, {{0, 0}, offscreen.extent}, offscreen.readback);
  memory_barrier(commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                 {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
}

Picture read_picture(const Offscreen& offscreen) {
  Picture picture;
  picture.width = static_cast<int>(offscreen.extent.width);
  picture.height = static_cast<int>(offscreen.extent.height);
  const std::span<const std::uint8_t> bytes =
      offscreen.readback.as<std::uint8_t>().first(std::size_t{4} * offscreen.extent.width * offscreen.extent.height);
  picture.rgba.assign(bytes.begin(), bytes.end());
  return picture;
}

Picture render_picture(const Device& device, Renderer& renderer, const Offscreen& offscreen, const Scene& scene) {
  Frame frame = create_frame(device);
  end_picture(device, frame, begin_picture(device, renderer, frame, scene, final_target(offscreen)));
  record_readback(begin_pass(device, frame), offscreen);
  end_pass(device, frame);
  submit(device, frame, VK_NULL_HANDLE, VK_NULL_HANDLE);
  finish(device, frame);
  return read_picture(offscreen);
}

}  // namespace sinew::gpu
