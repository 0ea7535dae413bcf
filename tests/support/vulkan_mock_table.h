#pragma once
// Entry points of VulkanMock by name.
#include <string_view>

#include "tests/support/vulkan_mock_commands.h"
#include "tests/support/vulkan_mock_objects.h"
#include "tests/support/vulkan_mock_physical.h"

namespace voyager::test {
namespace mock {

PFN_vkVoidFunction get_device(VkDevice, const char* name);

// As a driver: none of an extension that is not enabled.
inline bool is_enabled(const MockDevice& device, std::string_view name) {
  if (name == device.missing) return false;
  if (name == "vkGetMemoryFdKHR") return device.has(VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME);
  if (name == "vkGetSemaphoreFdKHR") return device.has(VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME);
  if (name == "vkGetMemoryHostPointerPropertiesEXT")
    return device.has(VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME);
  if (name == "vkWaitSemaphores" || name == "vkSignalSemaphore" ||
      name == "vkGetSemaphoreCounterValue")
    return device.version >= VK_API_VERSION_1_2;
  if (name.ends_with("KHR")) return device.has(VK_KHR_TIMELINE_SEMAPHORE_EXTENSION_NAME);
  return true;
}

using Table = std::map<std::string_view, PFN_vkVoidFunction>;

inline const Table& table() {
#define VULKAN_MOCK_ENTRY(name, function) \
  {"vk" #name, reinterpret_cast<PFN_vkVoidFunction>(static_cast<PFN_vk##name>(function))},
#define VULKAN_MOCK_PAIR(name)                                              \
  VULKAN_MOCK_ENTRY(Create##name, (create<Vk##name, Vk##name##CreateInfo>)) \
  VULKAN_MOCK_ENTRY(Destroy##name, destroy<Vk##name>)
  // clang-format off
  static const Table made = {
      VULKAN_MOCK_ENTRY(EnumerateDeviceExtensionProperties, enumerate_extensions)
      VULKAN_MOCK_ENTRY(GetPhysicalDeviceProperties2, get_properties)
      VULKAN_MOCK_ENTRY(GetPhysicalDeviceFeatures2, get_features)
      VULKAN_MOCK_ENTRY(GetPhysicalDeviceMemoryProperties, get_memory)
      VULKAN_MOCK_ENTRY(GetPhysicalDeviceQueueFamilyProperties, get_queue_families)
      VULKAN_MOCK_ENTRY(GetPhysicalDeviceFormatProperties, get_format)
      VULKAN_MOCK_ENTRY(GetPhysicalDeviceImageFormatProperties2, get_image_format)
      VULKAN_MOCK_ENTRY(GetPhysicalDeviceExternalBufferProperties, get_external_buffers)
      VULKAN_MOCK_ENTRY(GetPhysicalDeviceExternalSemaphoreProperties, get_external_semaphores)
      VULKAN_MOCK_ENTRY(GetDeviceProcAddr, get_device)
      VULKAN_MOCK_PAIR(Image)
      VULKAN_MOCK_PAIR(ImageView)
      VULKAN_MOCK_PAIR(Buffer)
      VULKAN_MOCK_PAIR(Semaphore)
      VULKAN_MOCK_PAIR(DescriptorSetLayout)
      VULKAN_MOCK_PAIR(DescriptorPool)
      VULKAN_MOCK_PAIR(PipelineLayout)
      VULKAN_MOCK_PAIR(ShaderModule)
      VULKAN_MOCK_ENTRY(GetImageMemoryRequirements, get_requirements<VkImage>)
      VULKAN_MOCK_ENTRY(GetBufferMemoryRequirements, get_requirements<VkBuffer>)
      VULKAN_MOCK_ENTRY(BindImageMemory, bind<VkImage>)
      VULKAN_MOCK_ENTRY(BindBufferMemory, bind<VkBuffer>)
      VULKAN_MOCK_ENTRY(AllocateMemory, allocate_memory)
      VULKAN_MOCK_ENTRY(FreeMemory, destroy<VkDeviceMemory>)
      VULKAN_MOCK_ENTRY(MapMemory, map_memory)
      VULKAN_MOCK_ENTRY(AllocateDescriptorSets, allocate_sets)
      VULKAN_MOCK_ENTRY(UpdateDescriptorSets, update_sets)
      VULKAN_MOCK_ENTRY(CreateGraphicsPipelines, create_pipelines)
      VULKAN_MOCK_ENTRY(DestroyPipeline, destroy<VkPipeline>)
      VULKAN_MOCK_ENTRY(CmdPipelineBarrier, barrier)
      VULKAN_MOCK_ENTRY(CmdCopyImage, copy_image)
      VULKAN_MOCK_ENTRY(CmdBlitImage, blit_image)
      VULKAN_MOCK_ENTRY(CmdCopyBufferToImage, buffer_to_image)
      VULKAN_MOCK_ENTRY(CmdCopyImageToBuffer, image_to_buffer)
      VULKAN_MOCK_ENTRY(CmdBindPipeline, bind_pipeline)
      VULKAN_MOCK_ENTRY(CmdBindDescriptorSets, bind_sets)
      VULKAN_MOCK_ENTRY(CmdPushConstants, push_constants)
      VULKAN_MOCK_ENTRY(CmdSetViewport, set_viewport)
      VULKAN_MOCK_ENTRY(CmdSetScissor, set_scissor)
      VULKAN_MOCK_ENTRY(CmdDraw, draw)
      VULKAN_MOCK_ENTRY(GetMemoryFdKHR, get_memory_fd)
      VULKAN_MOCK_ENTRY(GetSemaphoreFdKHR, get_semaphore_fd)
      VULKAN_MOCK_ENTRY(GetMemoryHostPointerPropertiesEXT, get_host_pointer)
      VULKAN_MOCK_ENTRY(WaitSemaphores, wait_semaphores)
      VULKAN_MOCK_ENTRY(SignalSemaphore, signal_semaphore)
      VULKAN_MOCK_ENTRY(GetSemaphoreCounterValue, get_counter)
      VULKAN_MOCK_ENTRY(WaitSemaphoresKHR, wait_semaphores)
      VULKAN_MOCK_ENTRY(SignalSemaphoreKHR, signal_semaphore)
      VULKAN_MOCK_ENTRY(GetSemaphoreCounterValueKHR, get_counter)
  };
  // clang-format on
#undef VULKAN_MOCK_PAIR
#undef VULKAN_MOCK_ENTRY
  return made;
}

inline PFN_vkVoidFunction get_device(VkDevice, const char* name) {
  const auto found = table().find(name);
  const bool there = found != table().end() && is_enabled(VulkanMock::current->device, name);
  return there ? found->second : nullptr;
}

}  // namespace mock

inline PFN_vkVoidFunction VKAPI_CALL VulkanMock::get_instance(VkInstance, const char* name) {
  return mock::get_device(handle(), name);
}

}  // namespace voyager::test
