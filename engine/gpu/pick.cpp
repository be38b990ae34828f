#include "engine/gpu/pick.h"

#include <algorithm>

#include "engine/gpu/draw_shapes.h"
#include "engine/gpu/image.h"
#include "engine/gpu/raster.h"
#include "engine/gpu/targets.h"

namespace sinew::gpu {

constexpr VkFormat id_format = VK_FORMAT_R32_UINT;

struct Picker {
  Paths paths;
  Owned<VkRenderPass> pass;
  Pipeline points, mesh;
  Image ids, depths;
  Owned<VkFramebuffer> framebuffer;
  Buffer id_values, depth_values;
  RasterImage raster;
};

namespace {

VkAttachmentDescription attachment(VkFormat format) {
  VkAttachmentDescription out{};
  out.format = format;
  out.samples = VK_SAMPLE_COUNT_1_BIT;
  out.loadOp = VK_ATTACHMENT_LOAD_OP_CLEAR;
  out.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  out.stencilLoadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  out.stencilStoreOp = VK_ATTACHMENT_STORE_OP_DONT_CARE;
  out.finalLayout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  return out;
}

Owned<VkRenderPass> create_pick_pass(const Device& device) {
  const VkAttachmentDescription attachments[] = {attachment(id_format), attachment(depth_format)};
  const VkAttachmentReference color{0, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL};
  const VkAttachmentReference depth{1, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL};
  VkSubpassDescription subpass{};
  subpass.pipelineBindPoint = VK_PIPELINE_BIND_POINT_GRAPHICS;
  subpass.colorAttachmentCount = 1;
  subpass.pColorAttachments = &color;
  subpass.pDepthStencilAttachment = &depth;
  const VkPipelineStageFlags drawing = VK_PIPELINE_STAGE_COLOR_ATTACHMENT_OUTPUT_BIT |
                                       VK_PIPELINE_STAGE_EARLY_FRAGMENT_TESTS_BIT |
                                       VK_PIPELINE_STAGE_LATE_FRAGMENT_TESTS_BIT;
  const VkAccessFlags drawn = VK_ACCESS_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_READ_BIT |
                              VK_ACCESS_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
  const VkPipelineStageFlags copying = VK_PIPELINE_STAGE_TRANSFER_BIT;
  const VkAccessFlags copied = VK_ACCESS_TRANSFER_READ_BIT;
  const VkSubpassDependency dependencies[] = {
      {VK_SUBPASS_EXTERNAL, 0, drawing | copying, drawing, drawn | copied, drawn, 0},
      {0, VK_SUBPASS_EXTERNAL, drawing, drawing | copying, drawn, drawn | copied, 0}};
  VkRenderPassCreateInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_CREATE_INFO};
  info.attachmentCount = 2;
  info.pAttachments = attachments;
  info.subpassCount = 1;
  info.pSubpasses = &subpass;
  info.dependencyCount = 2;
  info.pDependencies = dependencies;
  VkRenderPass pass = VK_NULL_HANDLE;
  vk_check(vkCreateRenderPass(device.handle, &info, nullptr, &pass), "vkCreateRenderPass");
  return {device.handle, pass, vkDestroyRenderPass};
}

void use_images(const Device& device, Picker& picker, VkExtent2D extent) {
  if (picker.ids.extent.width == extent.width && picker.ids.extent.height == extent.height) return;
  picker.framebuffer = {};
  picker.ids = create_image(device, extent, id_format, VK_SAMPLE_COUNT_1_BIT,
                            VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  picker.depths = create_image(device, extent, depth_format, VK_SAMPLE_COUNT_1_BIT,
                               VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  const VkImageView views[] = {picker.ids.view, picker.depths.view};
  VkFramebufferCreateInfo info{VK_STRUCTURE_TYPE_FRAMEBUFFER_CREATE_INFO};
  info.renderPass = picker.pass;
  info.attachmentCount = 2;
  info.pAttachments = views;
  info.width = extent.width;
  info.height = extent.height;
  info.layers = 1;
  VkFramebuffer framebuffer = VK_NULL_HANDLE;
  vk_check(vkCreateFramebuffer(device.handle, &info, nullptr, &framebuffer), "vkCreateFramebuffer");
  picker.framebuffer = {device.handle, framebuffer, vkDestroyFramebuffer};
}

VkRect2D cut(VkRect2D rectangle, VkExtent2D extent) {
  const auto side = [](std::int32_t offset, std::uint32_t length, std::uint32_t most) {
    const std::int64_t first = std::clamp<std::int64_t>(offset, 0, most);
    const std::int64_t last = std::clamp<std::int64_t>(std::int64_t{offset} + length, first, most);
    return std::pair{static_cast<std::int32_t>(first), static_cast<std::uint32_t>(last - first)};
  };
  const auto [x, width] = side(rectangle.offset.x, rectangle.extent.width, extent.width);
  const auto [y, height] = side(rectangle.offset.y, rectangle.extent.height, extent.height);
  return {{x, y}, {width, height}};
}

void record_ids(VkCommandBuffer commands, const Picker& picker, const Scene& scene, VkExtent2D extent,
                VkRect2D rectangle) {
  VkRenderPassBeginInfo info{VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO};
  info.renderPass = picker.pass;
  info.framebuffer = picker.framebuffer;
  info.renderArea = rectangle;
  const VkClearValue clear[2]{};
  info.clearValueCount = 2;
  info.pClearValues = clear;
  vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
  set_viewport(commands, extent);
  vkCmdSetScissor(commands, 0, 1, &rectangle);
  for (const PickRange& range : pick_ranges(scene)) {
    const Pipeline& pipeline = range.mesh ? picker.mesh : picker.points;
    shared::DrawConstants constants = range.mesh ? mesh_constants(scene, scene.meshes[range.item], extent)
                                                 : cloud_constants(scene, scene.clouds[range.item], extent);
    constants.first_id = range.first_id;
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle);
    push_constants(commands, pipeline, constants);
    if (range.mesh)
      draw_triangles(commands, scene.meshes[range.item]);
    else
      draw_vertices(commands, scene.clouds[range.item]);
  }
  vkCmdEndRenderPass(commands);
}

void pick_on_device(const Device& device, Picker& picker, const Scene& scene, VkExtent2D extent, PickResult& result) {
  const std::size_t pixels = result.ids.size();
  use_images(device, picker, extent);
  grow(device, picker.id_values, 4 * pixels, Memory::Readback);
  grow(device, picker.depth_values, 4 * pixels, Memory::Readback);
  Frame frame = create_frame(device);
  record_ids(begin_pass(device, frame), picker, scene, extent, result.rectangle);
  end_pass(device, frame);
  VkCommandBuffer commands = begin_pass(device, frame);
  copy_to_buffer(commands, picker.ids, result.rectangle, picker.id_values);
  copy_to_buffer(commands, picker.depths, result.rectangle, picker.depth_values);
  memory_barrier(commands, {VK_PIPELINE_STAGE_2_COPY_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT},
                 {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT});
  end_pass(device, frame);
  submit(device, frame, VK_NULL_HANDLE, VK_NULL_HANDLE);
  finish(device, frame);
  std::ranges::copy(picker.id_values.as<std::uint32_t>().first(pixels), result.ids.begin());
  std::ranges::copy(picker.depth_values.as<float>().first(pixels), result.depths.begin());
}

void pick_on_cpu(Picker& picker, const Scene& scene, VkExtent2D extent, PickResult& result) {
  std::vector<RasterItem> items = raster_items(scene, extent, false, 1);
  raster(picker.raster, static_cast<int>(extent.width), static_cast<int>(extent.height), items);
  const VkRect2D& rectangle = result.rectangle;
  for (std::uint32_t y = 0; y < rectangle.extent.height; ++y) {
    for (std::uint32_t x = 0; x < rectangle.extent.width; ++x) {
      const std::size_t row = static_cast<std::size_t>(rectangle.offset.y) + y;
      const std::size_t pixel = row * extent.width + static_cast<std::size_t>(rectangle.offset.x) + x;
      if (picker.raster.empty(pixel)) continue;
      result.ids[result.index(x, y)] = picker.raster.id(pixel);
      result.depths[result.index(x, y)] = picker.raster.depth(pixel);
    }
  }
}

}  // namespace

std::vector<PickRange> pick_ranges(const Scene& scene) {
  std::vector<PickRange> ranges;
  std::uint32_t next_id = 1;
  const auto add = [&](bool mesh, std::size_t item, std::size_t count) {
    ranges.push_back({mesh, item, next_id, static_cast<std::uint32_t>(count)});
    next_id += static_cast<std::uint32_t>(count);
  };
  for (std::size_t i = 0; i < scene.clouds.size(); ++i)
    if (scene.clouds[i].ghost <= 0) add(false, i, scene.clouds[i].points->count);
  for (std::size_t i = 0; i < scene.meshes.size(); ++i)
    if (scene.meshes[i].ghost <= 0) add(true, i, scene.meshes[i].triangles->count);
  return ranges;
}

bool pick_element(std::span<const PickRange> ranges, std::uint32_t id, PickRange& range, std::uint32_t& element) {
  for (const PickRange& candidate : ranges) {
    if (id < candidate.first_id || id - candidate.first_id >= candidate.count) continue;
    range = candidate;
    element = id - candidate.first_id;
    return true;
  }
  return false;
}

void DestroyPicker::operator()(Picker* picker) const {
  delete picker;
}

PickerHandle create_picker(const Device& device, const Paths& paths) {
  PickerHandle picker(new Picker);
  picker->paths = paths;
  picker->pass = create_pick_pass(device);
  DrawState state;
  state.bindings = point_bindings();
  state.attributes = point_attributes();
  std::erase_if(state.attributes,
                [](const auto& attribute) { return attribute.location == 1; });  // no light, no normal
  state.depth = Depth::TestAndWrite;
  state.constants = sizeof(shared::DrawConstants);
  state.vertex = "pick_mesh.vert";
  state.fragment = "pick_mesh.frag";
  picker->mesh = create_draw_pipeline(device, picker->pass, state);
  state.vertex = "pick_point.vert";
  state.fragment = "pick_point.frag";
  state.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  picker->points = create_draw_pipeline(device, picker->pass, state);
  return picker;
}

PickResult pick(const Device& device, Picker& picker, const Scene& scene, VkExtent2D extent, VkRect2D rectangle) {
  PickResult result;
  result.rectangle = cut(rectangle, extent);
  const std::size_t pixels = std::size_t{result.rectangle.extent.width} * result.rectangle.extent.height;
  result.ids.assign(pixels, 0);
  result.depths.assign(pixels, 0);
  if (pixels == 0) return result;
  if (picker.paths.draw_on_device || !can_raster(scene))
    pick_on_device(device, picker, scene, extent, result);
  else
    pick_on_cpu(picker, scene, extent, result);
  return result;
}

}  // namespace sinew::gpu
