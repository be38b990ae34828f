#pragma once
/// Pipelines: shaders with the state they run under.

#include <span>
#include <string_view>
#include <vector>

#include "engine/gpu/device.h"

namespace sinew::gpu {

struct Pipeline {
  Owned<VkPipelineLayout> layout;
  Owned<VkPipeline> handle;
};

enum class Depth { None, Test, TestAndWrite };  ///< test: nearer or equal (reversed depth)

/// Over what is there, by alpha; Premultiplied: the colour has been multiplied by alpha. The target's alpha stays.
enum class Blend { None, Over, Premultiplied };

struct DrawState {
  std::string_view vertex, fragment;  ///< files of shaders/
  std::vector<VkVertexInputBindingDescription> bindings;
  std::vector<VkVertexInputAttributeDescription> attributes;
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  Depth depth = Depth::None;
  Blend blend = Blend::None;
  bool writes_color = true;
  VkSampleCountFlagBits samples = VK_SAMPLE_COUNT_1_BIT;
  std::uint32_t constants = 0;                         ///< bytes of push constants, for all stages
  VkDescriptorSetLayout descriptors = VK_NULL_HANDLE;  ///< set 0, or none
};

/// Viewport and scissor are dynamic.
Pipeline create_draw_pipeline(const Device& device, VkRenderPass pass, const DrawState& state);
Pipeline create_compute_pipeline(const Device& device, std::string_view shader, std::uint32_t constants);

/// Viewport and scissor: the whole of `extent`.
void set_viewport(VkCommandBuffer commands, VkExtent2D extent);

template <class T>
void push_constants(VkCommandBuffer commands, const Pipeline& pipeline, const T& constants) {
  vkCmdPushConstants(commands, pipeline.layout, VK_SHADER_STAGE_ALL_GRAPHICS | VK_SHADER_STAGE_COMPUTE_BIT, 0,
                     sizeof(T), &constants);
}

}  // namespace sinew::gpu
