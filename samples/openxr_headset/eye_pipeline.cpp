#include "eye_pipeline.h"

#include <openxr/openxr.h>

#include "eye.vert.h"
#include "eye_color.frag.h"
#include "eye_depth.frag.h"
#include "graphics_states.h"
#include "render_pass.h"

namespace host {
namespace {

constexpr VkVertexInputBindingDescription kBinding = {0, sizeof(XrVector2f),
                                                      VK_VERTEX_INPUT_RATE_VERTEX};
constexpr VkVertexInputAttributeDescription kAttribute = {0, 0, VK_FORMAT_R32G32_SFLOAT, 0};

struct EyeStates : GraphicsStates {
  explicit EyeStates(bool with_depth) {
    input.vertexBindingDescriptionCount = input.vertexAttributeDescriptionCount = 1;
    input.pVertexBindingDescriptions = &kBinding;
    input.pVertexAttributeDescriptions = &kAttribute;
    depth.depthTestEnable = depth.depthWriteEnable = with_depth ? VK_TRUE : VK_FALSE;
    depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
  }
};

}  // namespace

// All is cleared: runtimes that hand out images in another layout are served too. The runtime sees
// to its own reads.
UniqueRenderPass make_eye_render_pass(VkDevice device, VkFormat colour,
                                      std::optional<VkFormat> depth) {
  const auto cleared = [](VkFormat format, VkImageLayout after) {
    return attachment(format, VK_ATTACHMENT_LOAD_OP_CLEAR, VK_IMAGE_LAYOUT_UNDEFINED, after);
  };
  const auto colours = cleared(colour, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL);
  if (!depth) return make_render_pass(device, colours, nullptr);
  const auto depths = cleared(*depth, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL);
  return make_render_pass(device, colours, &depths);
}

UniquePipelineLayout make_eye_layout(VkDevice device, VkDescriptorSetLayout set) {
  return make_pipeline_layout(
      device, set, {VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT, 0, sizeof(EyePush)});
}

UniquePipeline make_eye_pipeline(VkDevice device, VkPipelineLayout layout, VkRenderPass pass,
                                 bool depth) {
  const UniqueShaderModule vertex = make_shader(device, eye_vert);
  const UniqueShaderModule fragment =
      depth ? make_shader(device, eye_depth_frag) : make_shader(device, eye_color_frag);
  const VkPipelineShaderStageCreateInfo stages[] = {
      shader_stage(VK_SHADER_STAGE_VERTEX_BIT, vertex),
      shader_stage(VK_SHADER_STAGE_FRAGMENT_BIT, fragment)};
  return make_pipeline(device, stages, EyeStates(depth), layout, pass);
}

}  // namespace host
