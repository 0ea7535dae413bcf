#include "device_functions.h"

#include <stdexcept>
#include <string>
#include <type_traits>

namespace voyager_unity {

DeviceFunctions::DeviceFunctions(const VoyVulkanDeviceDesc& desc) : device(desc.device) {
  const auto find = reinterpret_cast<PFN_vkGetDeviceProcAddr>(
      desc.getInstanceProcAddr(desc.instance, "vkGetDeviceProcAddr"));
  const auto load = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(find(device, name));
  };
  load(create_render_pass, "vkCreateRenderPass");
  load(destroy_render_pass, "vkDestroyRenderPass");
  load(create_framebuffer, "vkCreateFramebuffer");
  load(destroy_framebuffer, "vkDestroyFramebuffer");
  load(create_image_view, "vkCreateImageView");
  load(destroy_image_view, "vkDestroyImageView");
  load(begin_render_pass, "vkCmdBeginRenderPass");
  load(end_render_pass, "vkCmdEndRenderPass");
  load(queue_submit, "vkQueueSubmit");
  load(wait_idle, "vkDeviceWaitIdle");
}

void check(VkResult result, const char* call) {
  if (result != VK_SUCCESS)
    throw std::runtime_error(std::string(call) + ": found VkResult " + std::to_string(result) +
                             ", expected VK_SUCCESS");
}

}  // namespace voyager_unity
