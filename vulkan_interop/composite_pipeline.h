#pragma once
// The state of a composite's pipelines: a triangle over the area, premultiplied colour over what
// is there, depth tested and written.
#include "vulkan_interop/resources.h"

namespace voyager::vulkan {

struct CompositeDesc {
  VkRenderPass render_pass = VK_NULL_HANDLE;  // none: dynamic rendering
  uint32_t subpass = 0;
  VkFormat color = VK_FORMAT_UNDEFINED, depth = VK_FORMAT_UNDEFINED;
};

// Throws Error(unsupported) where the device cannot draw to such attachments as the pipelines do.
void check_attachments(const PhysicalDevice& device, const CompositeDesc& desc);

struct CompositeStages {
  VkShaderModule vertex = VK_NULL_HANDLE, fragment = VK_NULL_HANDLE;
  bool places_depth = false;  // the fragment shader writes depth
  bool draws_color = true;
  bool reversed = false;  // depth
  bool reprojected = false;
};

Owned<VkPipeline> make_composite_pipeline(const Device& device, VkPipelineLayout layout,
                                          const CompositeDesc& desc, const CompositeStages& stages);

}  // namespace voyager::vulkan
