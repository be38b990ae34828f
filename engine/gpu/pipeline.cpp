#include "engine/gpu/pipeline.h"

#include "engine/gpu/shaders.h"

namespace sinew::gpu {
namespace {

Owned<VkShaderModule> create_module(const Device& device, std::string_view file) {
  const std::span<const std::uint32_t> code = shader_code(file);
  VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
  info.codeSize = code.size_bytes();
  info.pCode = code.data();
  VkShaderModule module = VK_NULL_HANDLE;
  vk_check(vkCreateShaderModule(device.handle, &info, nullptr, &module), "vkCreateShaderModule");
  return {device.handle, module, vkDestroyShaderModule};
}

Owned<VkPipelineLayout> create_layout(const Device& device, std::uint32_t constants,
                                      VkDescriptorSetLayout descriptors) {
  const VkPushConstantRange range{VK_SHADER_STAGE_ALL_GRAPHICS | VK_SHADER_STAGE_COMPUTE_BIT, 0, constants};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = descriptors != VK_NULL_HANDLE ? 1 : 0;
  info.pSetLayouts = &descriptors;
  info.pushConstantRangeCount = 1;
  info.pPushConstantRanges = &range;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  vk_check(vkCreatePipelineLayout(device.handle, &info, nullptr, &layout), "vkCreatePipelineLayout");
  return {device.handle, layout, vkDestroyPipelineLayout};
}

VkPipelineShaderStageCreateInfo stage(VkShaderStageFlagBits flag, VkShaderModule module) {
  VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage = flag;
  info.module = module;
  info.pName = "main";
  return info;
}

VkPipelineDepthStencilStateCreateInfo depth_state(Depth depth) {
  VkPipelineDepthStencilStateCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  info.depthTestEnable = depth != Depth::None;
  info.depthWriteEnable = depth == Depth::TestAndWrite;
  info.depthCompareOp = VK_COMPARE_OP_GREATER;
  return info;
}

VkPipelineColorBlendAttachmentState blend_state(const DrawState& state) {
  VkPipelineColorBlendAttachmentState info{};
  info.blendEnable = state.blend != Blend::None;
  info.srcColorBlendFactor = state.blend == Blend::Premultiplied ? VK_BLEND_FACTOR_ONE : VK_BLEND_FACTOR_SRC_ALPHA;
  info.dstColorBlendFactor = VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
  info.srcAlphaBlendFactor = VK_BLEND_FACTOR_ZERO;
  info.dstAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
  if (state.writes_color) info.colorWriteMask = 0xf;
  return info;
}

}  // namespace

Pipeline create_draw_pipeline(const Device& device, VkRenderPass pass, const DrawState& state) {
  Pipeline pipeline;
  pipeline.layout = create_layout(device, state.constants, state.descriptors);
  const Owned<VkShaderModule> vertex = create_module(device, state.vertex);
  const Owned<VkShaderModule> fragment = create_module(device, state.fragment);
  const VkPipelineShaderStageCreateInfo stages[] = {stage(VK_SHADER_STAGE_VERTEX_BIT, vertex),
                                                    stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};

  VkPipelineVertexInputStateCreateInfo input{VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
  input.vertexBindingDescriptionCount = static_cast<std::uint32_t>(state.bindings.size());
  input.pVertexBindingDescriptions = state.bindings.data();
  input.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(state.attributes.size());
  input.pVertexAttributeDescriptions = state.attributes.data();
  VkPipelineInputAssemblyStateCreateInfo assembly{VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = state.topology;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = 1;
  viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.lineWidth = 1;
  VkPipelineMultisampleStateCreateInfo samples{VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = state.samples;
  const VkPipelineDepthStencilStateCreateInfo depth = depth_state(state.depth);
  const VkPipelineColorBlendAttachmentState attachment = blend_state(state);
  VkPipelineColorBlendStateCreateInfo blend{VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = 1;
  blend.pAttachments = &attachment;
  const VkDynamicState dynamic_states[] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = 2;
  dynamic.pDynamicStates = dynamic_states;

  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO};
  info.stageCount = 2;
  info.pStages = stages;
  info.pVertexInputState = &input;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = pipeline.layout;
  info.renderPass = pass;
  VkPipeline handle = VK_NULL_HANDLE;
  vk_check(vkCreateGraphicsPipelines(device.handle, VK_NULL_HANDLE, 1, &info, nullptr, &handle),
           "vkCreateGraphicsPipelines");
  pipeline.handle = {device.handle, handle, vkDestroyPipeline};
  return pipeline;
}

Pipeline create_compute_pipeline(const Device& device, std::string_view shader, std::uint32_t constants) {
  Pipeline pipeline;
  pipeline.layout = create_layout(device, constants, VK_NULL_HANDLE);
  const Owned<VkShaderModule> module = create_module(device, shader);
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = stage(VK_SHADER_STAGE_COMPUTE_BIT, module);
  info.layout = pipeline.layout;
  VkPipeline handle = VK_NULL_HANDLE;
  vk_check(vkCreateComputePipelines(device.handle, VK_NULL_HANDLE, 1, &info, nullptr, &handle),
           "vkCreateComputePipelines");
  pipeline.handle = {device.handle, handle, vkDestroyPipeline};
  return pipeline;
}

void set_viewport(VkCommandBuffer commands, VkExtent2D extent) {
  const VkViewport viewport{0, 0, static_cast<float>(extent.width), static_cast<float>(extent.height), 0, 1};
  const VkRect2D scissor{{0, 0}, extent};
  vkCmdSetViewport(commands, 0, 1, &viewport);
  vkCmdSetScissor(commands, 0, 1, &scissor);
}

}  // namespace sinew::gpu
