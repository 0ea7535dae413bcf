#pragma once
// The states of a graphics pipeline that are the same for most.
#include <vulkan/vulkan.h>

#include <span>

#include "unique.h"

namespace host {

UniqueShaderModule make_shader(VkDevice device, std::span<const uint32_t> code);
// Runs main().
VkPipelineShaderStageCreateInfo shader_stage(VkShaderStageFlagBits which,
                                             const UniqueShaderModule& shader);

// Triangles without vertex buffers, without depth, one sample, no blending; viewport and scissor
// are dynamic. Change what differs, before make_pipeline().
struct GraphicsStates {
  GraphicsStates();
  GraphicsStates(const GraphicsStates&) = delete;
  GraphicsStates& operator=(const GraphicsStates&) = delete;

  VkPipelineVertexInputStateCreateInfo input = {};
  VkPipelineInputAssemblyStateCreateInfo assembly = {};
  VkPipelineViewportStateCreateInfo viewport = {};
  VkPipelineRasterizationStateCreateInfo raster = {};
  VkPipelineMultisampleStateCreateInfo samples = {};
  VkPipelineDepthStencilStateCreateInfo depth = {};
  VkPipelineColorBlendAttachmentState write = {};
  VkPipelineColorBlendStateCreateInfo blend = {};
  VkPipelineDynamicStateCreateInfo dynamic = {};
};

// set: NULL for none.
UniquePipelineLayout make_pipeline_layout(VkDevice device, VkDescriptorSetLayout set,
                                          const VkPushConstantRange& constants);
UniquePipeline make_pipeline(VkDevice device,
                             std::span<const VkPipelineShaderStageCreateInfo> stages,
                             const GraphicsStates& states, VkPipelineLayout layout,
                             VkRenderPass pass);

}  // namespace host
