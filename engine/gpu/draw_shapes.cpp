#include "engine/gpu/draw_shapes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/geometry/check.h"

namespace sinew::gpu {
namespace {

using shared::DrawConstants;

DrawState shape_state(std::string_view vertex, std::string_view fragment, VkSampleCountFlagBits samples) {
  DrawState state;
  state.vertex = vertex;
  state.fragment = fragment;
  state.bindings = point_bindings();
  state.attributes = point_attributes();
  state.depth = Depth::TestAndWrite;
  state.samples = samples;
  state.constants = sizeof(DrawConstants);
  return state;
}

void bind_points(VkCommandBuffer commands, const Points& points, bool rest) {
  const Buffer& positions = rest ? points.rest : points.positions;
  const Buffer& normals = rest ? points.rest_normals : points.normals;
  // Without normals something must be bound all the same; the shader is told not to use it.
  const VkBuffer buffers[] = {positions.handle, points.has_normals ? normals.handle : positions.handle,
                              points.colors.handle};
  const VkDeviceSize offsets[3]{};
  vkCmdBindVertexBuffers(commands, 0, 3, buffers, offsets);
}

std::uint32_t ghost_color(const Look& look, Color own, double opacity) {
  Color color = own.a > 0 ? own : look.ghost;
  color.a = static_cast<std::uint8_t>(std::clamp(256 * opacity, 0.0, 255.0));
  return packed(color);
}

void draw_cloud(VkCommandBuffer commands, const Pipeline& pipeline, const Scene& scene, const CloudItem& item,
                VkExtent2D extent, VkSampleCountFlagBits samples) {
  shared::DrawConstants constants = cloud_constants(scene, item, extent);
  if (samples != VK_SAMPLE_COUNT_1_BIT) constants.flags |= shared::draw_smooth;
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle);
  push_constants(commands, pipeline, constants);
  draw_vertices(commands, item);
}

void draw_mesh(VkCommandBuffer commands, const Pipeline& pipeline, const Scene& scene, const MeshItem& item,
               VkExtent2D extent) {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipeline.handle);
  push_constants(commands, pipeline, mesh_constants(scene, item, extent));
  draw_triangles(commands, item);
}

}  // namespace

std::vector<VkVertexInputBindingDescription> point_bindings() {
  return {{0, 12, VK_VERTEX_INPUT_RATE_VERTEX},
          {1, 12, VK_VERTEX_INPUT_RATE_VERTEX},
          {2, sizeof(PointColor), VK_VERTEX_INPUT_RATE_VERTEX}};
}

std::vector<VkVertexInputAttributeDescription> point_attributes() {
  return {
      {0, 0, VK_FORMAT_R32G32B32_SFLOAT, 0}, {1, 1, VK_FORMAT_R32G32B32_SFLOAT, 0}, {2, 2, VK_FORMAT_R8G8B8A8_UINT, 0}};
}

ShapePipelines create_shape_pipelines(const Device& device, VkRenderPass pass, VkSampleCountFlagBits samples) {
  ShapePipelines pipelines;
  pipelines.samples = samples;
  DrawState backdrop;
  backdrop.vertex = "screen.vert";
  backdrop.fragment = "backdrop.frag";
  backdrop.samples = samples;
  backdrop.constants = sizeof(shared::ComposeConstants);
  pipelines.backdrop = create_draw_pipeline(device, pass, backdrop);

  DrawState points = shape_state("point.vert", "point.frag", samples);
  points.topology = VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
  DrawState mesh = shape_state("mesh.vert", "mesh.frag", samples);
  pipelines.points = create_draw_pipeline(device, pass, points);
  pipelines.mesh = create_draw_pipeline(device, pass, mesh);
  for (DrawState* state : {&points, &mesh}) {
    state->depth = Depth::Test;
    state->blend = Blend::Over;
  }
  pipelines.ghost_points = create_draw_pipeline(device, pass, points);
  pipelines.ghost_mesh = create_draw_pipeline(device, pass, mesh);
  return pipelines;
}

std::uint32_t packed(Color color) {
  return color.r | color.g << 8 | color.b << 16 | static_cast<std::uint32_t>(color.a) << 24;
}

Eigen::Vector3d light_direction(const Camera& camera) {
  return view_matrix(camera).topLeftCorner<3, 3>().transpose() * Eigen::Vector3d(-0.45, 0.75, 0.75).normalized();
}

DrawConstants draw_constants(const Scene& scene, const Points& points, VkExtent2D extent) {
  DrawConstants constants{};
  const Eigen::Affine3d to_scene(Eigen::Translation3d(points.centre));
  const double aspect = static_cast<double>(extent.width) / extent.height;
  constants.clip = (clip_matrix(scene.camera, aspect) * to_scene.matrix()).cast<float>();
  if (scene.camera.orthographic)
    constants.eye << (scene.camera.eye - scene.camera.target).normalized().cast<float>(), 0;
  else
    constants.eye << (scene.camera.eye - points.centre).cast<float>(), 1;
  constants.light = light_direction(scene.camera).cast<float>();
  constants.mark_colors[0] = packed(scene.look.handle);
  constants.mark_colors[1] = packed(scene.look.fixed);
  constants.mark_colors[2] = packed(scene.look.rigid);
  constants.flags = (points.has_normals ? shared::draw_normals : 0) | (scene.up == UpAxis::Z ? shared::draw_z_up : 0);
  return constants;
}

shared::DrawConstants cloud_constants(const Scene& scene, const CloudItem& item, VkExtent2D extent) {
  DrawConstants constants = draw_constants(scene, *item.points, extent);
  constants.size = static_cast<float>(item.size);
  if (item.ghost > 0) constants.flags |= shared::draw_ghost;
  constants.ghost_color = ghost_color(scene.look, item.ghost_color, item.ghost);
  return constants;
}

DrawConstants mesh_constants(const Scene& scene, const MeshItem& item, VkExtent2D extent) {
  DrawConstants constants = draw_constants(scene, *item.points, extent);
  if (item.flat || !item.points->has_normals) constants.flags |= shared::draw_flat;
  if (item.ghost > 0) constants.flags |= shared::draw_ghost;
  constants.ghost_color = ghost_color(scene.look, item.ghost_color, item.ghost);
  return constants;
}

shared::ComposeConstants compose_constants(const Scene& scene, VkExtent2D extent) {
  shared::ComposeConstants constants{};
  constants.top = packed(scene.look.backdrop_top);
  constants.bottom = packed(scene.look.backdrop_bottom);
  constants.outline = scene.outline_selected ? packed(scene.look.outline) : 0;
  constants.edl_strength = static_cast<float>(scene.look.edl_strength);
  constants.edl_radius = static_cast<float>(scene.look.edl_radius);
  constants.size = {static_cast<float>(extent.width), static_cast<float>(extent.height)};
  const Camera& camera = scene.camera;
  if (camera.orthographic)
    constants.linear_depth = static_cast<float>((camera.far - camera.near) / (camera.distance() * std::numbers::ln2));
  return constants;
}

void draw_backdrop(VkCommandBuffer commands, const ShapePipelines& pipelines, const Scene& scene, VkExtent2D extent) {
  vkCmdBindPipeline(commands, VK_PIPELINE_BIND_POINT_GRAPHICS, pipelines.backdrop.handle);
  push_constants(commands, pipelines.backdrop, compose_constants(scene, extent));
  vkCmdDraw(commands, 3, 1, 0, 0);
}

void draw_clouds(VkCommandBuffer commands, const ShapePipelines& pipelines, const Scene& scene, VkExtent2D extent) {
  for (const CloudItem& item : scene.clouds)
    if (item.ghost <= 0) draw_cloud(commands, pipelines.points, scene, item, extent, pipelines.samples);
  for (const CloudItem& item : scene.clouds)
    if (item.ghost > 0) draw_cloud(commands, pipelines.ghost_points, scene, item, extent, pipelines.samples);
}

void draw_meshes(VkCommandBuffer commands, const ShapePipelines& pipelines, const Scene& scene, VkExtent2D extent) {
  for (const MeshItem& item : scene.meshes)
    if (item.ghost <= 0) draw_mesh(commands, pipelines.mesh, scene, item, extent);
  for (const MeshItem& item : scene.meshes)
    if (item.ghost > 0) draw_mesh(commands, pipelines.ghost_mesh, scene, item, extent);
}

void draw_vertices(VkCommandBuffer commands, const CloudItem& item) {
  const Points& points = *item.points;
  const auto count = static_cast<std::uint32_t>(std::min(points.count, item.count));
  if (count == 0) return;
  bind_points(commands, points, item.rest);
  if (count < points.count && points.order.size > 0) {
    vkCmdBindIndexBuffer(commands, points.order.handle, 0, VK_INDEX_TYPE_UINT32);
    vkCmdDrawIndexed(commands, count, 1, 0, 0, 0);
  } else {
    vkCmdDraw(commands, count, 1, 0, 0);
  }
}

void draw_triangles(VkCommandBuffer commands, const MeshItem& item) {
  if (item.triangles->count == 0) return;
  bind_points(commands, *item.points, item.rest);
  vkCmdBindIndexBuffer(commands, item.triangles->indices.handle, 0, VK_INDEX_TYPE_UINT32);
  vkCmdDrawIndexed(commands, static_cast<std::uint32_t>(3 * item.triangles->count), 1, 0, 0, 0);
}

}  // namespace sinew::gpu
