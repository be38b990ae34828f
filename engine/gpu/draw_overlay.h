#pragma once
/// Drawing over the finished shapes: ground, lines, dots. They read the shapes' depth themselves, so that what is
/// hidden can be faint and the final pass needs no depth.

#include "engine/gpu/pipeline.h"
#include "engine/gpu/scene.h"
#include "shaders/shared.h"

namespace sinew::gpu {

struct OverlayPipelines {
  Pipeline ground, lines, dots;
};
OverlayPipelines create_overlay_pipelines(const Device& device, VkRenderPass pass, VkDescriptorSetLayout descriptors);

/// Lines and dots of one picture as the shaders read them, relative to the camera's target.
struct OverlayData {
  Buffer lines, dots;
  std::uint32_t line_count = 0, dot_count = 0;
};
void write_overlay(const Device& device, OverlayData& data, const Scene& scene);

shared::GroundConstants ground_constants(const Scene& scene, VkExtent2D extent);

/// `depths` is the descriptor set of the shapes' images.
void draw_overlay(VkCommandBuffer commands, const OverlayPipelines& pipelines, const OverlayData& data,
                  VkDescriptorSet depths, const Scene& scene, VkExtent2D extent, bool with_ground);

}  // namespace sinew::gpu
