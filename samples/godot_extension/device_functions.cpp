#include "device_functions.h"

#include <stdexcept>
#include <string>
#include <type_traits>

namespace voyager_godot {

DeviceFunctions::DeviceFunctions(PFN_vkGetInstanceProcAddr get, const NativeDevice& native)
    : device(native.device),
      get_device_proc_addr(
          reinterpret_cast<PFN_vkGetDeviceProcAddr>(get(native.instance, "vkGetDeviceProcAddr"))) {
  const auto load = [&](auto& function, const char* name) {
    function = reinterpret_cast<std::remove_reference_t<decltype(function)>>(
        get_device_proc_addr(device, name));
  };
  load(create_command_pool, "vkCreateCommandPool");
  load(destroy_command_pool, "vkDestroyCommandPool");
  load(allocate_command_buffers, "vkAllocateCommandBuffers");
  load(reset_command_buffer, "vkResetCommandBuffer");
  load(begin_command_buffer, "vkBeginCommandBuffer");
  load(end_command_buffer, "vkEndCommandBuffer");
  load(pipeline_barrier, "vkCmdPipelineBarrier");
  load(copy_image, "vkCmdCopyImage");
  load(create_fence, "vkCreateFence");
  load(destroy_fence, "vkDestroyFence");
  load(wait_for_fences, "vkWaitForFences");
  load(reset_fences, "vkResetFences");
  load(queue_submit, "vkQueueSubmit");
}

void check(VkResult result, const char* call) {
  if (result != VK_SUCCESS)
    throw std::runtime_error(std::string(call) + ": found VkResult " + std::to_string(result) +
                             ", expected VK_SUCCESS");
}

}  // namespace voyager_godot
