#pragma once
/// Drawing over the finished shapes: ground, splats, lines, dots. They read the shapes' depth themselves, so that what
/// is hidden can be faint and the final pass needs no depth.

#include "engine/gpu/pipeline.h"
#include "engine/gpu/scene.h"
#include "shaders/shared.h"

namespace sinew::gpu {

struct OverlayPipelines {
  Pipeline ground, splats, lines, dots;
};
OverlayPipelines create_overlay_pipelines(const Device& device, VkRenderPass pass, VkDescriptorSetLayout descriptors);

/// Splats, lines and dots of one picture as the shaders read them; the last two relative to the camera's target.
struct OverlayData {
  Buffer splats, lines, dots;
  std::uint32_t splat_count = 0, line_count = 0, dot_count = 0;
};
/// `with_shapes`: ground and splats too, which the raster draws itself.
void write_overlay(const Device& device, OverlayData& data, const Scene& scene, VkExtent2D extent, bool with_shapes);

shared::GroundConstants ground_constants(const Scene& scene, VkExtent2D extent);

/// `depths` is the descriptor set of the shapes' images.
void draw_overlay(VkCommandBuffer commands, const OverlayPipelines& pipelines, const OverlayData& data,
                  VkDescriptorSet depths, const Scene& scene, VkExtent2D extent, bool with_shapes);

}  // namespace sinew::gpu
