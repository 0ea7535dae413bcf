#pragma once
// The entry points that the host's vkGetInstanceProcAddr has; this library links no Vulkan.
#define VK_NO_PROTOTYPES
#include <vulkan/vulkan_core.h>

namespace voyager::vulkan {

// clang-format off
#define VOYAGER_VULKAN_INSTANCE_FUNCTIONS(X) \
  X(EnumerateDeviceExtensionProperties) X(GetPhysicalDeviceProperties2) \
  X(GetPhysicalDeviceFeatures2) X(GetPhysicalDeviceMemoryProperties) \
  X(GetPhysicalDeviceQueueFamilyProperties) X(GetPhysicalDeviceFormatProperties) \
  X(GetPhysicalDeviceImageFormatProperties2) X(GetPhysicalDeviceExternalBufferProperties) \
  X(GetPhysicalDeviceExternalSemaphoreProperties) \
  X(GetDeviceProcAddr)

#define VOYAGER_VULKAN_DEVICE_FUNCTIONS(X) \
  X(CreateImage) X(DestroyImage) X(GetImageMemoryRequirements) X(BindImageMemory) \
  X(CreateImageView) X(DestroyImageView) \
  X(CreateBuffer) X(DestroyBuffer) X(GetBufferMemoryRequirements) X(BindBufferMemory) \
  X(AllocateMemory) X(FreeMemory) X(MapMemory) \
  X(CreateSemaphore) X(DestroySemaphore) \
  X(CreateDescriptorSetLayout) X(DestroyDescriptorSetLayout) \
  X(CreateDescriptorPool) X(DestroyDescriptorPool) \
  X(AllocateDescriptorSets) X(UpdateDescriptorSets) \
  X(CreatePipelineLayout) X(DestroyPipelineLayout) \
  X(CreateShaderModule) X(DestroyShaderModule) \
  X(CreateGraphicsPipelines) X(DestroyPipeline) \
  X(CmdPipelineBarrier) X(CmdCopyImage) X(CmdBlitImage) \
  X(CmdCopyBufferToImage) X(CmdCopyImageToBuffer) \
  X(CmdBindPipeline) X(CmdBindDescriptorSets) X(CmdPushConstants) \
  X(CmdSetViewport) X(CmdSetScissor) X(CmdDraw)

// Null where the host did not enable what has them.
#define VOYAGER_VULKAN_OPTIONAL_FUNCTIONS(X) \
  X(GetMemoryFdKHR) X(GetSemaphoreFdKHR) X(GetMemoryHostPointerPropertiesEXT) \
  X(WaitSemaphores) X(SignalSemaphore) X(GetSemaphoreCounterValue)
// clang-format on

#define VOYAGER_VULKAN_DECLARE(name) PFN_vk##name name = nullptr;

struct InstanceFunctions {
  VOYAGER_VULKAN_INSTANCE_FUNCTIONS(VOYAGER_VULKAN_DECLARE)
};
struct DeviceFunctions {
  VOYAGER_VULKAN_DEVICE_FUNCTIONS(VOYAGER_VULKAN_DECLARE)
  VOYAGER_VULKAN_OPTIONAL_FUNCTIONS(VOYAGER_VULKAN_DECLARE)
};

#undef VOYAGER_VULKAN_DECLARE

// Throw Error(invalid_argument) where an entry point is missing, which names it.
InstanceFunctions load_instance_functions(PFN_vkGetInstanceProcAddr get, VkInstance instance);
DeviceFunctions load_device_functions(PFN_vkGetDeviceProcAddr get, VkDevice device);

// Throws for a status that is an error: std::bad_alloc, Error(over_budget),
// Error(device_lost), else Error(internal).
void check(VkResult status, const char* what);

}  // namespace voyager::vulkan
