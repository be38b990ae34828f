#include "engine/gpu/targets.h"

#include "engine/gpu/pipeline.h"

namespace sinew::gpu {
namespace {

VkAttachmentDescription2 attachment(VkFormat format, VkSampleCountFlagBits samples, VkAttachmentLoadOp load,
                                    VkAttachmentStoreOp store) {
  VkAttachmentDescription2 out{VK_STRUCTURE_TYPE_ATTACHMENT_DESCRIPTION_2};
  out.format = format;
  out.samples = samples;
  out.loadOp = load;
  out.storeOp = store;
  out.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  out.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  out.finalLayout = has_depth(format) ? depth_layout : color_layout;
  if (samples != VK_SAMPLE_COUNT_1_BIT)
    out.finalLayout =
        has_depth(format) ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  return out;
}

VkAttachmentReference2 reference(std::uint32_t index, VkFormat format) {
  VkAttachmentReference2 out{VK_STRUCTURE_TYPE_ATTACHMENT_REFERENCE_2};
  out.attachment = index;
  out.layout =
      has_depth(format) ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  out.aspectMask = has_depth(format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
  return out;
}

VkSubpassDependency2 dependency(std::uint32_t from, std::uint32_t to) {
  const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                       VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                       VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
  const VkAccessFlags drawn = VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT |
                              VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                              VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  const VkPipelineStageFlags using_it = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_TRANSFER_BIT;
  const VkAccessFlags used = VK_ACCESS_SHADER_READ_BIT | VK_ACCESS_TRANSFER_READ_BIT | VK_ACCESS_TRANSFER_WRITE_BIT;
  VkSubpassDependency2 out{VK_STRUCTURE_TYPE_SUBPASS_DEPENDENCY_2};
  out.srcSubpass = from;
  out.dstSubpass = to;
  out.srcStageMask = drawing | (from == VK_SUBPASS_EXTERNAL ? using_it : 0);
  out.srcAccessMask = drawn | (from == VK_SUBPASS_EXTERNAL ? used : 0);
  out.dstStageMask = drawing | (to == VK_SUBPASS_EXTERNAL ? using_it : 0);
  out.dstAccessMask = drawn | (to == VK_SUBPASS_EXTERNAL ? used : 0);
  return out;
}

Owned<VkRenderPass> create_pass(const Device& device, std::span<const VkAttachmentDescription2> attachments,
                                const VkSubpassDescription2& subpass) {
  const VkSubpassDependency2 dependencies[] = {dependency(VK_SUBPASS_EXTERNAL, 0), dependency(0, VK_SUBPASS_EXTERNAL)};
  VkRenderPassCreateInfo2 info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO_2};
  info.attachmentCount = static_cast<std::uint32_t>(attachments.size());
  info.pAttachments = attachments.data();
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = 2;
  info.pDependencies = dependencies;
  VkRenderPass pass = VK_NULL_HANDLE;
  vk_check(vkCreateRenderPass2(device.handle, &info, nullptr, &pass), "vkCreateRenderPass2");
  return {device.handle, pass, vkDestroyRenderPass};
}

}  // namespace

Owned<VkRenderPass> create_shape_pass(const Device& device, VkSampleCountFlagBits samples) {
  const VkAttachmentReference2 color = reference(0, color_format), depth = reference(1, depth_format);
  VkSubpassDescription2 subpass{VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_2};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &color;
  subpass.pDepthStencilAttachment = &depth;
  // The backdrop covers all of the colour.
  const VkAttachmentLoadOp load_color = VK_ATTACHMENT_LOAD_OP_DONT_CARE, load_depth = VK_ATTACHMENT_LOAD_OP_CLEAR;
  if (samples == VK_SAMPLE_COUNT_1_BIT) {
    const VkAttachmentDescription2 attachments[] = {
        attachment(color_format, samples, load_color, VK_ATTACHMENT_STORE_OP_STORE),
        attachment(depth_format, samples, load_depth, VK_ATTACHMENT_STORE_OP_STORE)};
    return create_pass(device, attachments, subpass);
  }
  const VkAttachmentReference2 resolved_color = reference(2, color_format), resolved_depth = reference(3, depth_format);
  VkSubpassDescriptionDepthStencilResolve resolve{VK_STRUCTURE_TYPE_SUBPASS_DESCRIPTION_DEPTH_STENCIL_RESOLVE};
  resolve.depthResolveMode = VK_RESOLVE_MODE_SAMPLE_ZERO_BIT;
  resolve.stencilResolveMode = VK_RESOLVE_MODE_NONE;
  resolve.pDepthStencilResolveAttachment = &resolved_depth;
  subpass.pResolveAttachments = &resolved_color;
  subpass.pNext = &resolve;
  const VkAttachmentDescription2 attachments[] = {
      attachment(color_format, samples, load_color, VK_ATTACHMENT_STORE_OP_DONT_CARE),
      attachment(depth_format, samples, load_depth, VK_ATTACHMENT_STORE_OP_DONT_CARE),
      attachment(color_format, VK_SAMPLE_COUNT_1_BIT, VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_STORE),
      attachment(depth_format, VK_SAMPLE_COUNT_1_BIT, VK_ATTACHMENT_LOAD_OP_DONT_CARE, VK_ATTACHMENT_STORE_OP_STORE)};
  return create_pass(device, attachments, subpass);
}

Targets create_targets(const Device& device, VkExtent2D extent, VkSampleCountFlagBits samples, VkRenderPass pass) {
  const VkImageUsageFlags shared_usage =
      VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  const VkImageUsageFlags color_usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  const VkImageUsageFlags depth_usage = VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  Targets targets;
  targets.samples = samples;
  targets.extent = extent;
  targets.color = create_image(device, extent, color_format, VK_SAMPLE_COUNT_1_BIT, color_usage | shared_usage);
  targets.depth = create_image(device, extent, depth_format, VK_SAMPLE_COUNT_1_BIT, depth_usage | shared_usage);
  std::vector<VkImageView> views{targets.color.view, targets.depth.view};
  if (samples != VK_SAMPLE_COUNT_1_BIT) {
    targets.sample_color = create_image(device, extent, color_format, samples, color_usage);
    targets.sample_depth = create_image(device, extent, depth_format, samples, depth_usage);
    views.insert(views.begin(), {targets.sample_color.view, targets.sample_depth.view});
  }
  VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  info.renderPass = pass;
  info.attachmentCount = static_cast<std::uint32_t>(views.size());
  info.pAttachments = views.data();
  info.width = extent.width;
  info.height = extent.height;
  info.layers = 1;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  vk_check(vkCreateFramebuffer(device.handle, &info, nullptr, &framebuffer), "vkCreateFramebuffer");
  targets.framebuffer = {device.handle, framebuffer, vkDestroyFramebuffer};
  return targets;
}

void begin_shape_pass(VkCommandBuffer commands, VkRenderPass pass, const Targets& targets) {
  VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  info.renderPass = pass;
  info.framebuffer = targets.framebuffer;
  info.renderArea.extent = targets.extent;
  const VkClearValue clear[2]{};
  info.clearValueCount = 2;
  info.pClearValues = clear;
  vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
  set_viewport(commands, targets.extent);
}

}  // namespace sinew::gpu
