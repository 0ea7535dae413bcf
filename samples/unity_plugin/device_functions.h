#pragma once
// The Vulkan functions that the plugin calls itself. It links no Vulkan library: Unity has loaded
// one, and other plugins may have intercepted it.
#include <voyager/voyager_vulkan.h>

namespace voyager_unity {

struct DeviceFunctions {
  // vkGetInstanceProcAddr, the instance and the device are those of `desc`.
  explicit DeviceFunctions(const VoyVulkanDeviceDesc& desc);

  VkDevice device;
  PFN_vkCreateRenderPass create_render_pass;
  PFN_vkDestroyRenderPass destroy_render_pass;
  PFN_vkCreateFramebuffer create_framebuffer;
  PFN_vkDestroyFramebuffer destroy_framebuffer;
  PFN_vkCreateImageView create_image_view;
  PFN_vkDestroyImageView destroy_image_view;
  PFN_vkCmdBeginRenderPass begin_render_pass;
  PFN_vkCmdEndRenderPass end_render_pass;
  PFN_vkQueueSubmit queue_submit;
  PFN_vkDeviceWaitIdle wait_idle;
};

// Throws std::runtime_error, which names the call, for anything but VK_SUCCESS.
void check(VkResult result, const char* call);

}  // namespace voyager_unity
