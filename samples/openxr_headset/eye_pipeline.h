#pragma once
// The Vulkan objects behind EyePass.
#include <optional>

#include "unique.h"

namespace host {

// As the shaders have it.
struct EyePush {
  float scale[2], offset[2];
  int32_t layer;
  float a, b;
};

UniqueRenderPass make_eye_render_pass(VkDevice device, VkFormat colour,
                                      std::optional<VkFormat> depth);
// set: of colour and, with depth, depth.
UniquePipelineLayout make_eye_layout(VkDevice device, VkDescriptorSetLayout set);
UniquePipeline make_eye_pipeline(VkDevice device, VkPipelineLayout layout, VkRenderPass pass,
                                 bool depth);

}  // namespace host
