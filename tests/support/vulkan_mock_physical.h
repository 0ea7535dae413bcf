#pragma once
// Entry points of VulkanMock that tell what the device has.
#include <algorithm>
#include <cstring>

#include "tests/support/vulkan_mock.h"

namespace voyager::test::mock {

template <class Wanted>
Wanted* find_in_chain(void* next, VkStructureType type) {
  for (auto* at = static_cast<VkBaseOutStructure*>(next); at != nullptr; at = at->pNext)
    if (at->sType == type) return reinterpret_cast<Wanted*>(at);
  return nullptr;
}
template <class Wanted>
const Wanted* find_in_chain(const void* next, VkStructureType type) {
  return find_in_chain<Wanted>(const_cast<void*>(next), type);
}

inline VkResult enumerate_extensions(VkPhysicalDevice, const char*, uint32_t* count,
                                     VkExtensionProperties* out) {
  VulkanMock& mock = *VulkanMock::current;
  if (const VkResult status = mock.next()) return status;
  const auto there = static_cast<uint32_t>(mock.device.extensions.size());
  if (out == nullptr) {
    *count = there;
    return VK_SUCCESS;
  }
  *count = std::min(*count, there);
  for (uint32_t i = 0; i < *count; ++i) {
    out[i] = {};
    std::strncpy(out[i].extensionName, mock.device.extensions[i].c_str(),
                 sizeof out[i].extensionName - 1);
  }
  return *count < there ? VK_INCOMPLETE : VK_SUCCESS;
}

inline void get_properties(VkPhysicalDevice, VkPhysicalDeviceProperties2* out) {
  const MockDevice& device = VulkanMock::current->device;
  out->properties.apiVersion = device.version;
  std::strcpy(out->properties.deviceName, "mock");
  if (auto* id = find_in_chain<VkPhysicalDeviceIDProperties>(
          out->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES))
    for (uint8_t i = 0; i < VK_UUID_SIZE; ++i) id->deviceUUID[i] = static_cast<uint8_t>(i + 1);
  if (auto* host = find_in_chain<VkPhysicalDeviceExternalMemoryHostPropertiesEXT>(
          out->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_MEMORY_HOST_PROPERTIES_EXT))
    host->minImportedHostPointerAlignment = device.host_pointer_alignment;
}

inline void get_features(VkPhysicalDevice, VkPhysicalDeviceFeatures2* out) {
  if (auto* timelines = find_in_chain<VkPhysicalDeviceTimelineSemaphoreFeatures>(
          out->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES))
    timelines->timelineSemaphore = VulkanMock::current->device.timelines ? VK_TRUE : VK_FALSE;
}

// One that is the device's own, one that is mapped, one that is mapped and cached.
inline void get_memory(VkPhysicalDevice, VkPhysicalDeviceMemoryProperties* out) {
  const VkMemoryPropertyFlags mapped =
      VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
  *out = {};
  out->memoryTypeCount = 3;
  out->memoryTypes[0].propertyFlags = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  out->memoryTypes[1].propertyFlags = mapped;
  out->memoryTypes[2].propertyFlags = mapped | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
  out->memoryHeapCount = 1;
}

inline void get_external_semaphores(VkPhysicalDevice,
                                    const VkPhysicalDeviceExternalSemaphoreInfo* info,
                                    VkExternalSemaphoreProperties* out) {
  const MockDevice& device = VulkanMock::current->device;
  const auto* type = find_in_chain<VkSemaphoreTypeCreateInfo>(
      info->pNext, VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO);
  const bool timeline = type != nullptr && type->semaphoreType == VK_SEMAPHORE_TYPE_TIMELINE;
  if (timeline ? device.exports_timelines : device.exports_binaries)
    out->externalSemaphoreFeatures = VK_EXTERNAL_SEMAPHORE_FEATURE_EXPORTABLE_BIT;
}

}  // namespace voyager::test::mock
