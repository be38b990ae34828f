#include "engine/gpu/draw_overlay.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "engine/gpu/draw_shapes.h"
#include "engine/gpu/splats.h"
#include "shaders/shared.h"

namespace sinew::gpu {
namespace {

struct LineInstance {
  shared::vec3 from, to;
  Color color;
  shared::vec2 style;
};
static_assert(sizeof(LineInstance) == 36);

struct DotInstance {
  shared::vec3 position;
  Color color, outline;
  shared::vec3 style;
};
static_assert(sizeof(DotInstance) == 32);

DrawState overlay_state(std::string_view vertex, std::string_view fragment, VkDescriptorSetLayout descriptors) {
  DrawState state;
  state.vertex = vertex;
  state.fragment = fragment;
  state.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  state.blend = Blend::Over;
  state.constants = sizeof(shared::OverlayConstants);
  state.descriptors = descriptors;
  return state;
}

/// Depth with 1 a little nearer than it is, so that what lies on a surface is seen; `part` of the distance.
shared::vec2 depth_bias(const Camera& camera, double part) {
  if (!camera.orthographic) return {static_cast<float>(1 + part), 0};
  return {1, static_cast<float>(part * camera.distance() / (camera.far - camera.near))};
}

shared::OverlayConstants overlay_constants(const Scene& scene, VkExtent2D extent, double bias) {
  shared::OverlayConstants constants{};
  const Eigen::Affine3d to_scene(Eigen::Translation3d(scene.camera.target));
  const double aspect = static_cast<double>(extent.width) / extent.height;
  constants.clip = (clip_matrix(scene.camera, aspect) * to_scene.matrix()).cast<float>();
  constants.size = {static_cast<float>(extent.width), static_cast<float>(extent.height)};
  constants.depth_bias = depth_bias(scene.camera, bias);
  return constants;
}

template <class Constants>
void draw_instances(VkCommandBuffer commands, const Pipeline& pipeline, const Buffer& instances, std::uint32_t count,
                    const Constants& constants) {
  if (count == 0) return;
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle);
  push_constants(commands, pipeline, constants);
  const VkDeviceSize offset = 0;
  vkCmdBindVertexBuffers(commands, 0, 1, instances.handle.address(), &offset);
  vkCmdDraw(commands, 4, count, 0, 0);
}

}  // namespace

shared::GroundConstants ground_constants(const Scene& scene, VkExtent2D extent) {
  const Ground& ground = scene.ground;
  const Eigen::Vector3d u = Eigen::Vector3d::UnitX();
  const Eigen::Vector3d v = scene.up == UpAxis::Y ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
  Eigen::Matrix4d to_scene = Eigen::Matrix4d::Identity();
  to_scene.block<3, 1>(0, 0) = u * ground.cell;
  to_scene.block<3, 1>(0, 1) = v * ground.cell;
  to_scene.block<3, 1>(0, 2).setZero();
  to_scene.block<3, 1>(0, 3) = ground.middle;
  shared::GroundConstants constants{};
  const double aspect = static_cast<double>(extent.width) / extent.height;
  constants.clip = (clip_matrix(scene.camera, aspect) * to_scene).cast<float>();
  constants.origin = {static_cast<float>(std::fmod(ground.middle.dot(u) / ground.cell, 10.0)),
                      static_cast<float>(std::fmod(ground.middle.dot(v) / ground.cell, 10.0))};
  constants.color = packed(scene.look.grid);
  constants.radius = static_cast<float>(ground.cells);
  return constants;
}

OverlayPipelines create_overlay_pipelines(const Device& device, VkRenderPass pass, VkDescriptorSetLayout descriptors) {
  OverlayPipelines pipelines;
  DrawState ground = overlay_state("ground.vert", "ground.frag", descriptors);
  ground.constants = sizeof(shared::GroundConstants);
  pipelines.ground = create_draw_pipeline(device, pass, ground);

  DrawState splats = overlay_state("splat.vert", "splat.frag", descriptors);
  splats.blend = Blend::Premultiplied;
  splats.constants = sizeof(shared::SplatConstants);
  splats.bindings = {{0, sizeof(shared::SplatInstance), VK_VERTEX_INPUT_RATE_INSTANCE}};
  splats.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(shared::SplatInstance, at)},
                       {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(shared::SplatInstance, conic)},
                       {2, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(shared::SplatInstance, reach)},
                       {3, 0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::SplatInstance, color)}};
  pipelines.splats = create_draw_pipeline(device, pass, splats);

  DrawState lines = overlay_state("line.vert", "line.frag", descriptors);
  lines.bindings = {{0, sizeof(LineInstance), VK_VERTEX_INPUT_RATE_INSTANCE}};
  lines.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(LineInstance, from)},
                      {1, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(LineInstance, to)},
                      {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(LineInstance, color)},
                      {3, 0, VK_FORMAT_R32G32_SFLOAT, offsetof(LineInstance, style)}};
  pipelines.lines = create_draw_pipeline(device, pass, lines);

  DrawState dots = overlay_state("dot.vert", "dot.frag", descriptors);
  dots.bindings = {{0, sizeof(DotInstance), VK_VERTEX_INPUT_RATE_INSTANCE}};
  dots.attributes = {{0, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(DotInstance, position)},
                     {1, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(DotInstance, color)},
                     {2, 0, VK_FORMAT_R8G8B8A8_UNORM, offsetof(DotInstance, outline)},
                     {3, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(DotInstance, style)}};
  pipelines.dots = create_draw_pipeline(device, pass, dots);
  return pipelines;
}

void write_overlay(const Device& device, OverlayData& data, const Scene& scene, VkExtent2D extent, bool with_shapes) {
  data.splat_count = 0;
  if (with_shapes && !scene.splats.empty()) {
    const std::vector<shared::SplatInstance> splats = splat_instances(scene, extent);
    data.splat_count = static_cast<std::uint32_t>(splats.size());
    grow(device, data.splats, splats.size() * sizeof(shared::SplatInstance), Memory::Upload);
    std::ranges::copy(splats, static_cast<shared::SplatInstance*>(data.splats.mapped));
  }
  const Eigen::Vector3d origin = scene.camera.target;
  data.line_count = static_cast<std::uint32_t>(scene.lines.size());
  data.dot_count = static_cast<std::uint32_t>(scene.dots.size());
  grow(device, data.lines, scene.lines.size() * sizeof(LineInstance), Memory::Upload);
  grow(device, data.dots, scene.dots.size() * sizeof(DotInstance), Memory::Upload);
  LineInstance* line = static_cast<LineInstance*>(data.lines.mapped);
  for (const Line& in : scene.lines)
    *line++ = {(in.from - origin).cast<float>(), (in.to - origin).cast<float>(), in.color,
               Eigen::Vector2d(in.width, in.hidden).cast<float>()};
  DotInstance* dot = static_cast<DotInstance*>(data.dots.mapped);
  for (const Dot& in : scene.dots)
    *dot++ = {(in.position - origin).cast<float>(), in.color, in.outline_color,
              Eigen::Vector3d(in.radius, in.outline, in.hidden).cast<float>()};
}

void draw_overlay(VkCommandBuffer commands, const OverlayPipelines& pipelines, const OverlayData& data,
                  VkDescriptorSet depths, const Scene& scene, VkExtent2D extent, bool with_shapes) {
  // The layouts of all four agree in their descriptor set.
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.ground.layout, 0, 1, &depths, 0,
                          nullptr);
  if (with_shapes && scene.ground.show) {
    vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.ground.handle);
    push_constants(commands, pipelines.ground, ground_constants(scene, extent));
    vkCmdDraw(commands, 4, 1, 0, 0);
  }
  const shared::SplatConstants splats{{static_cast<float>(extent.width), static_cast<float>(extent.height)}};
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.splats.layout, 0, 1, &depths, 0,
                          nullptr);
  draw_instances(commands, pipelines.splats, data.splats, data.splat_count, splats);
  vkCmdBindDescriptorSets(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.lines.layout, 0, 1, &depths, 0, nullptr);
  draw_instances(commands, pipelines.lines, data.lines, data.line_count, overlay_constants(scene, extent, 0.004));
  draw_instances(commands, pipelines.dots, data.dots, data.dot_count, overlay_constants(scene, extent, 0.012));
}

}  // namespace sinew::gpu
