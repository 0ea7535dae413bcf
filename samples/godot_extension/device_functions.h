#pragma once
// The Vulkan functions that the extension calls itself.
#include <voyager/voyager_vulkan.h>

#include "native_handles.h"

namespace voyager_godot {

struct DeviceFunctions {
  DeviceFunctions(PFN_vkGetInstanceProcAddr get, const NativeDevice& native);

  VkDevice device;
  PFN_vkGetDeviceProcAddr get_device_proc_addr;
  PFN_vkCreateCommandPool create_command_pool;
  PFN_vkDestroyCommandPool destroy_command_pool;
  PFN_vkAllocateCommandBuffers allocate_command_buffers;
  PFN_vkResetCommandBuffer reset_command_buffer;
  PFN_vkBeginCommandBuffer begin_command_buffer;
  PFN_vkEndCommandBuffer end_command_buffer;
  PFN_vkCmdPipelineBarrier pipeline_barrier;
  PFN_vkCmdCopyImage copy_image;
  PFN_vkCreateFence create_fence;
  PFN_vkDestroyFence destroy_fence;
  PFN_vkWaitForFences wait_for_fences;
  PFN_vkResetFences reset_fences;
  PFN_vkQueueSubmit queue_submit;

  // True if Godot enabled an extension that has this function: Vulkan gives out no others.
  bool has(const char* function) const { return get_device_proc_addr(device, function) != nullptr; }
};

// Throws std::runtime_error, which names the call, for anything but VK_SUCCESS.
void check(VkResult result, const char* call);

}  // namespace voyager_godot
