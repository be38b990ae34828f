#include "engine/gpu/renderer.h"

#include "engine/geometry/check.h"
#include "engine/gpu/draw_overlay.h"
#include "engine/gpu/draw_shapes.h"
#include "engine/gpu/raster.h"
#include "engine/gpu/targets.h"

namespace sinew::gpu {

struct Renderer {
  Paths paths;
  VkSampleCountFlagBits most_samples = VK_SAMPLE_COUNT_1_BIT;
  /// Of one sample a pixel, and of four.
  struct Shapes {
    Owned<VkRenderPass> pass;
    ShapePipelines pipelines;
  } plain, smooth;
  Targets targets;
  RasterScratch raster;
  Buffer raster_colors, raster_depths;  ///< the CPU's picture on its way to the target and to `targets.depth`
  Owned<VkRenderPass> final_pass;
  Owned<VkSampler> sampler;
  Owned<VkDescriptorSetLayout> set_layout;
  Owned<VkDescriptorPool> pool;
  VkDescriptorSet images = VK_NULL_HANDLE;  ///< colour and depth of the targets
  Pipeline compose;
  OverlayPipelines overlay;
  OverlayData overlay_data;
};

namespace {

void create_descriptors(const Device& device, Renderer& renderer) {
  VkSamplerCreateInfo sampler_info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  VkSampler sampler = VK_NULL_HANDLE;
  vk_check(vkCreateSampler(device.handle, &sampler_info, nullptr, &sampler), "vkCreateSampler");
  renderer.sampler = {device.handle, sampler, vkDestroySampler};

  VkDescriptorSetLayoutBinding bindings[2]{};
  for (std::uint32_t i = 0; i < 2; ++i)
    bindings[i] = {i, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 1, VK_SHADER_STAGE_FRAGMENT_BIT, nullptr};
  VkDescriptorSetLayoutCreateInfo layout_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  layout_info.bindingCount = 2;
  layout_info.pBindings = bindings;
  VkDescriptorSetLayout layout = VK_NULL_HANDLE;
  vk_check(vkCreateDescriptorSetLayout(device.handle, &layout_info, nullptr, &layout), "vkCreateDescriptorSetLayout");
  renderer.set_layout = {device.handle, layout, vkDestroyDescriptorSetLayout};

  const VkDescriptorPoolSize size{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 2};
  VkDescriptorPoolCreateInfo pool_info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  pool_info.maxSets = 1;
  pool_info.poolSizeCount = 1;
  pool_info.pPoolSizes = &size;
  VkDescriptorPool pool = VK_NULL_HANDLE;
  vk_check(vkCreateDescriptorPool(device.handle, &pool_info, nullptr, &pool), "vkCreateDescriptorPool");
  renderer.pool = {device.handle, pool, vkDestroyDescriptorPool};

  VkDescriptorSetAllocateInfo set_info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  set_info.descriptorPool = pool;
  set_info.descriptorSetCount = 1;
  set_info.pSetLayouts = &layout;
  vk_check(vkAllocateDescriptorSets(device.handle, &set_info, &renderer.images), "vkAllocateDescriptorSets");
}

/// The images for a size; they are made anew only when it changes.
void use_targets(const Device& device, Renderer& renderer, VkExtent2D extent, VkSampleCountFlagBits samples) {
  const Targets& now = renderer.targets;
  if (now.extent.width == extent.width && now.extent.height == extent.height && now.samples == samples) return;
  renderer.targets = {};
  const Renderer::Shapes& shapes = samples == VK_SAMPLE_COUNT_1_BIT ? renderer.plain : renderer.smooth;
  renderer.targets = create_targets(device, extent, samples, shapes.pass);

  const VkDescriptorImageInfo infos[] = {{renderer.sampler, renderer.targets.color.view, color_layout},
                                         {renderer.sampler, renderer.targets.depth.view, depth_layout}};
  VkWriteDescriptorSet writes[2]{};
  for (std::uint32_t i = 0; i < 2; ++i) {
    writes[i].sType = VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET;
    writes[i].dstSet = renderer.images;
    writes[i].dstBinding = i;
    writes[i].descriptorCount = 1;
    writes[i].descriptorType = VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER;
    writes[i].pImageInfo = &infos[i];
  }
  vkUpdateDescriptorSets(device.handle, 2, writes, 0, nullptr);
}

Renderer::Shapes create_shapes(const Device& device, VkSampleCountFlagBits samples) {
  Renderer::Shapes shapes;
  shapes.pass = create_shape_pass(device, samples);
  shapes.pipelines = create_shape_pipelines(device, shapes.pass, samples);
  return shapes;
}

/// Draws the shapes into the renderer's own images.
void record_shapes(const Device& device, Renderer& renderer, Frame& frame, const Scene& scene, VkExtent2D extent) {
  const VkSampleCountFlagBits samples = scene.smooth_edges ? renderer.most_samples : VK_SAMPLE_COUNT_1_BIT;
  use_targets(device, renderer, extent, samples);
  const Renderer::Shapes& shapes = samples == VK_SAMPLE_COUNT_1_BIT ? renderer.plain : renderer.smooth;
  VkCommandBuffer commands = begin_pass(device, frame);
  begin_shape_pass(commands, shapes.pass, renderer.targets);
  draw_backdrop(commands, shapes.pipelines, scene, extent);
  draw_clouds(commands, shapes.pipelines, scene, extent);
  draw_meshes(commands, shapes.pipelines, scene, extent);
  vkCmdEndRenderPass(commands);
  end_pass(device, frame);
}

/// The CPU's picture, copied: colours into the target itself, depths to where lines and dots look for them.
void record_raster(const Device& device, Renderer& renderer, Frame& frame, const Scene& scene,
                   const FinalTarget& target) {
  const VkExtent2D extent = target.extent;
  use_targets(device, renderer, extent, VK_SAMPLE_COUNT_1_BIT);
  const std::size_t pixels = std::size_t{extent.width} * extent.height;
  grow(device, renderer.raster_colors, 4 * pixels, Memory::Upload);
  grow(device, renderer.raster_depths, 4 * pixels, Memory::Upload);
  RasterOutput out;
  out.colors = static_cast<std::uint32_t*>(renderer.raster_colors.mapped);
  out.depths = static_cast<float*>(renderer.raster_depths.mapped);
  out.blue_first = target.format == VK_FORMAT_B8G8R8A8_UNORM;
  raster_scene(renderer.raster, scene, extent, out);

  const Access before{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_2_COPY_BIT |
                          VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                      VK_ACCESS_2_NONE};
  const Access copied{VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT};
  const Access drawn{VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT,
                     VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT};
  const Access sampled{VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT};
  const VkImageLayout undefined = VK_IMAGE_LAYOUT_UNDEFINED, to_copy = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  const VkImage depths = renderer.targets.depth.handle;
  VkCommandBuffer commands = begin_pass(device, frame);
  image_barrier(commands, depths, depth_format, before, undefined, copied, to_copy);
  copy_from_buffer(commands, renderer.raster_depths, 0, depths, depth_format, extent);
  image_barrier(commands, depths, depth_format, copied, to_copy, sampled, depth_layout);
  image_barrier(commands, target.image, target.format, before, undefined, copied, to_copy);
  copy_from_buffer(commands, renderer.raster_colors, 0, target.image, target.format, extent);
  image_barrier(commands, target.image, target.format, copied, to_copy, drawn,
                VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  end_pass(device, frame);
}

void compose(Renderer& renderer, VkCommandBuffer commands, const Scene& scene, VkExtent2D extent) {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, renderer.compose.handle);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, renderer.compose.layout, 0, 1, &renderer.images, 0,
                          nullptr);
  push_constants(commands, renderer.compose, compose_constants(scene, extent));
  vkCmdDraw(commands, 3, 1, 0, 0);
}

}  // namespace

Owned<VkRenderPass> create_final_pass(const Device& device, VkFormat format, Start start, VkImageLayout layout) {
  VkAttachmentDescription attachment{};
  attachment.format = format;
  attachment.samples = VK_SAMPLE_COUNT_1_BIT;
  attachment.loadOp = start == Start::Keep ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  attachment.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  attachment.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  attachment.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  attachment.initialLayout =
      start == Start::Keep ? VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL : VK_IMAGE_LAYOUT_UNDEFINED;
  attachment.finalLayout = layout;
  const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &color;
  // Whoever read the picture before (a copy, the screen) has finished; whoever reads it next sees all of it.
  const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT;
  const VkAccessFlags drawn = VK_ACCESS_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT;
  const VkPipelineStageFlags copying = VK_PIPELINE_STAGE_TRANSFER_BIT;
  const VkSubpassDependency dependencies[] = {
      {VK_SUBPASS_EXTERNAL, 0, drawing | copying, drawing, drawn | VK_ACCESS_TRANSFER_READ_BIT, drawn, 0},
      {0, VK_SUBPASS_EXTERNAL, drawing, drawing | copying, drawn, drawn | VK_ACCESS_TRANSFER_READ_BIT, 0}};
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = 1;
  info.pAttachments = &attachment;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = 2;
  info.pDependencies = dependencies;
  VkRenderPass pass = VK_NULL_HANDLE;
  vk_check(vkCreateRenderPass(device.handle, &info, nullptr, &pass), "vkCreateRenderPass");
  return {device.handle, pass, vkDestroyRenderPass};
}

void DestroyRenderer::operator()(Renderer* renderer) const {
  delete renderer;
}

RendererHandle create_renderer(const Device& device, const Paths& paths, VkFormat format) {
  RendererHandle renderer(new Renderer);
  renderer->paths = paths;
  const VkSampleCountFlags both =
      device.limits.framebufferColorSampleCounts & device.limits.framebufferDepthSampleCounts;
  if ((both & VK_SAMPLE_COUNT_4_BIT) != 0) renderer->most_samples = VK_SAMPLE_COUNT_4_BIT;
  renderer->plain = create_shapes(device, VK_SAMPLE_COUNT_1_BIT);
  if (renderer->most_samples != VK_SAMPLE_COUNT_1_BIT) renderer->smooth = create_shapes(device, renderer->most_samples);
  create_descriptors(device, *renderer);

  renderer->final_pass = create_final_pass(device, format, Start::Cover, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  DrawState compose;
  compose.vertex = "screen.vert";
  compose.fragment = "compose.frag";
  compose.constants = sizeof(shared::ComposeConstants);
  compose.descriptors = renderer->set_layout;
  renderer->compose = create_draw_pipeline(device, renderer->final_pass, compose);
  renderer->overlay = create_overlay_pipelines(device, renderer->final_pass, renderer->set_layout);
  return renderer;
}

VkCommandBuffer begin_picture(const Device& device, Renderer& renderer, Frame& frame, const Scene& scene,
                              const FinalTarget& target) {
  CHECK(!frame.pending);
  const bool on_device = renderer.paths.draw_on_device || !can_raster(scene);
  write_overlay(device, renderer.overlay_data, scene, target.extent, on_device);
  if (on_device)
    record_shapes(device, renderer, frame, scene, target.extent);
  else
    record_raster(device, renderer, frame, scene, target);

  VkCommandBuffer commands = begin_pass(device, frame);
  VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  info.renderPass = on_device ? target.cover : target.keep;
  info.framebuffer = target.framebuffer;
  info.renderArea.extent = target.extent;
  vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
  set_viewport(commands, target.extent);
  if (on_device) compose(renderer, commands, scene, target.extent);
  draw_overlay(commands, renderer.overlay, renderer.overlay_data, renderer.images, scene, target.extent, on_device);
  return commands;
}

void end_picture(const Device& device, Frame& frame, VkCommandBuffer commands) {
  vkCmdEndRenderPass(commands);
  end_pass(device, frame);
}

}  // namespace sinew::gpu
