#pragma once
/// Drawing of points and meshes: backdrop, solid shapes, then the ghosts over them.

#include "engine/gpu/pipeline.h"
#include "engine/gpu/scene.h"
#include "shaders/shared.h"

namespace sinew::gpu {

struct ShapePipelines {
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  Pipeline backdrop, points, mesh, ghost_points, ghost_mesh;
};
ShapePipelines create_shape_pipelines(const Device& device, VkRenderPass pass, VkSampleCountFlagBits samples);

/// Constants of points drawn in this scene: matrices in the points' own coordinates, light, marks.
shared::DrawConstants draw_constants(const Scene& scene, const Points& points, VkExtent2D extent);
shared::DrawConstants cloud_constants(const Scene& scene, const CloudItem& item, VkExtent2D extent);
shared::DrawConstants mesh_constants(const Scene& scene, const MeshItem& item, VkExtent2D extent);
shared::ComposeConstants compose_constants(const Scene& scene, VkExtent2D extent);

std::uint32_t packed(Color color);
/// Unit vector towards the key light: over the left shoulder of who looks.
Eigen::Vector3d light_direction(const Camera& camera);

void draw_backdrop(VkCommandBuffer commands, const ShapePipelines& pipelines, const Scene& scene, VkExtent2D extent);
void draw_clouds(VkCommandBuffer commands, const ShapePipelines& pipelines, const Scene& scene, VkExtent2D extent);
void draw_meshes(VkCommandBuffer commands, const ShapePipelines& pipelines, const Scene& scene, VkExtent2D extent);

/// Binds positions, normals and colours and draws; the pipeline and its constants are set.
void draw_vertices(VkCommandBuffer commands, const CloudItem& item);
void draw_triangles(VkCommandBuffer commands, const MeshItem& item);
std::vector<VkVertexInputBindingDescription> point_bindings();
std::vector<VkVertexInputAttributeDescription> point_attributes();

}  // namespace sinew::gpu
