#include "vulkan_interop/composite_pipeline.h"

#include <string>

#include "runtime/base/error.h"

namespace voyager::vulkan {
namespace {

bool encodes(VkFormat format) {
  switch (format) {
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_SRGB:
    case VK_FORMAT_A8B8G8R8_SRGB_PACK32:
      return true;
    default:
      return false;
  }
}

bool has_depth(VkFormat format) {
  return format >= VK_FORMAT_D16_UNORM && format <= VK_FORMAT_D32_SFLOAT_S8_UINT &&
         format != VK_FORMAT_S8_UINT;
}

// Drivers are asked about formats that they must know only.
bool is_core(VkFormat format) {
  return format > VK_FORMAT_UNDEFINED && format <= VK_FORMAT_ASTC_12x12_SRGB_BLOCK;
}

[[noreturn]] void refuse(const char* field, VkFormat found, const char* expected) {
  throw Error(ErrorCode::unsupported, std::string("desc.") + field + ": found VkFormat " +
                                          std::to_string(found) + ", expected " + expected);
}

// Premultiplied, over what is there.
VkPipelineColorBlendAttachmentState over(bool writes) {
  const VkColorComponentFlags all = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                                    VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  return {VK_TRUE,
          VK_BLEND_FACTOR_ONE,
          VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
          VK_BLEND_OP_ADD,
          VK_BLEND_FACTOR_ONE,
          VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA,
          VK_BLEND_OP_ADD,
          writes ? all : VkColorComponentFlags{0}};
}

// The shaders, and what they are specialised to.
struct ShaderState {
  ShaderState(const CompositeDesc& desc, const CompositeStages& from)
      : choices{encodes(desc.color), from.reprojected, !from.draws_color} {
    const auto stage = [](VkShaderStageFlagBits at, VkShaderModule module,
                          const VkSpecializationInfo* info) {
      return VkPipelineShaderStageCreateInfo{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO,
                                             nullptr,
                                             0,
                                             at,
                                             module,
                                             "main",
                                             info};
    };
    special = {from.places_depth ? 3u : 2u, entries, sizeof choices, choices};
    stages[0] = stage(VK_SHADER_STAGE_VERTEX_BIT, from.vertex, nullptr);
    stages[1] = stage(VK_SHADER_STAGE_FRAGMENT_BIT, from.fragment, &special);
  }
  ShaderState(const ShaderState&) = delete;
  ShaderState& operator=(const ShaderState&) = delete;

  // As the shaders number them; that of number 1 is the depth shader's alone.
  VkBool32 choices[3];
  VkSpecializationMapEntry entries[3] = {{0, 0, sizeof(VkBool32)},
                                         {2, sizeof(VkBool32), sizeof(VkBool32)},
                                         {1, 2 * sizeof(VkBool32), sizeof(VkBool32)}};
  VkSpecializationInfo special;
  VkPipelineShaderStageCreateInfo stages[2];
};

// Where the triangle goes: no vertices, the area set by the commands.
struct RasterState {
  RasterState() {
    input.sType = VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO;
    assembly.sType = VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO;
    assembly.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
    viewport.sType = VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO;
    viewport.viewportCount = viewport.scissorCount = 1;
    dynamic.sType = VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO;
    dynamic.dynamicStateCount = 2;
    dynamic.pDynamicStates = set_by_commands;
    raster.sType = VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO;
    raster.lineWidth = 1;
    samples.sType = VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO;
    samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  }
  RasterState(const RasterState&) = delete;
  RasterState& operator=(const RasterState&) = delete;

  VkDynamicState set_by_commands[2] = {VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR};
  VkPipelineVertexInputStateCreateInfo input{};
  VkPipelineInputAssemblyStateCreateInfo assembly{};
  VkPipelineViewportStateCreateInfo viewport{};
  VkPipelineDynamicStateCreateInfo dynamic{};
  VkPipelineRasterizationStateCreateInfo raster{};
  VkPipelineMultisampleStateCreateInfo samples{};
};

// What becomes of the attachments.
struct AttachmentState {
  AttachmentState(const CompositeDesc& desc, const CompositeStages& stages)
      : color(over(stages.draws_color)) {
    depth.sType = VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO;
    depth.depthTestEnable = depth.depthWriteEnable = stages.places_depth;
    depth.depthCompareOp =
        stages.reversed ? VK_COMPARE_OP_GREATER_OR_EQUAL : VK_COMPARE_OP_LESS_OR_EQUAL;
    blend.sType = VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO;
    blend.attachmentCount = 1;
    blend.pAttachments = &color;
    rendering.sType = VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO;
    rendering.colorAttachmentCount = 1;
    rendering.pColorAttachmentFormats = &desc.color;
    rendering.depthAttachmentFormat = desc.depth;
  }
  AttachmentState(const AttachmentState&) = delete;
  AttachmentState& operator=(const AttachmentState&) = delete;

  VkPipelineColorBlendAttachmentState color;
  VkPipelineDepthStencilStateCreateInfo depth{};
  VkPipelineColorBlendStateCreateInfo blend{};
  VkPipelineRenderingCreateInfo rendering{};  // where there is no render pass
};

}  // namespace

void check_attachments(const PhysicalDevice& device, const CompositeDesc& desc) {
  if (!is_core(desc.color) ||
      !device.draws_to(desc.color, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT |
                                       VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT))
    refuse("colorFormat", desc.color, "one that the device can draw to and blend");
  if (desc.depth == VK_FORMAT_UNDEFINED) return;
  if (!has_depth(desc.depth) ||
      !device.draws_to(desc.depth, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT))
    refuse("depthFormat", desc.depth, "one with depth that the device can draw to, or UNDEFINED");
}

Owned<VkPipeline> make_composite_pipeline(const Device& device, VkPipelineLayout layout,
                                          const CompositeDesc& desc,
                                          const CompositeStages& stages) {
  const ShaderState shaders(desc, stages);
  const RasterState raster;
  const AttachmentState attachments(desc, stages);
  VkGraphicsPipelineCreateInfo info{};
  info.sType = VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO;
  info.pNext = desc.render_pass == VK_NULL_HANDLE ? &attachments.rendering : nullptr;
  info.stageCount = 2;
  info.pStages = shaders.stages;
  info.pVertexInputState = &raster.input;
  info.pInputAssemblyState = &raster.assembly;
  info.pViewportState = &raster.viewport;
  info.pRasterizationState = &raster.raster;
  info.pMultisampleState = &raster.samples;
  info.pDepthStencilState = &attachments.depth;
  info.pColorBlendState = &attachments.blend;
  info.pDynamicState = &raster.dynamic;
  info.layout = layout;
  info.renderPass = desc.render_pass;
  info.subpass = desc.subpass;
  const DeviceFunctions& vk = device.functions();
  const auto create = [&](VkDevice owner, const VkGraphicsPipelineCreateInfo* made,
                          const VkAllocationCallbacks* callbacks, VkPipeline* pipeline) {
    return vk.CreateGraphicsPipelines(owner, VK_NULL_HANDLE, 1, made, callbacks, pipeline);
  };
  return make<VkPipeline>(device, create, vk.DestroyPipeline, info, "vkCreateGraphicsPipelines");
}

}  // namespace voyager::vulkan
