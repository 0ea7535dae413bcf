#pragma once
// Entry points of VulkanMock that tell what the device has.
#include <algorithm>
#include <cstring>

#include "tests/support/vulkan_mock_device.h"

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

inline void get_queue_families(VkPhysicalDevice, uint32_t* count, VkQueueFamilyProperties* out) {
  EXPECT_EQ(out, nullptr);
  *count = VulkanMock::current->device.queue_families;
}

// What drivers have of the formats that tests name; none of those that they make up.
inline void get_format(VkPhysicalDevice, VkFormat format, VkFormatProperties* out) {
  EXPECT_LE(format, VK_FORMAT_ASTC_12x12_SRGB_BLOCK) << "no driver knows it";
  constexpr VkFormatFeatureFlags kDraws = VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;
  *out = {};
  switch (format) {
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      out->optimalTilingFeatures = kDraws | VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BLEND_BIT;
      break;
    case VK_FORMAT_R8G8B8A8_UINT:
      out->optimalTilingFeatures = kDraws;
      break;
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_S8_UINT:
      out->optimalTilingFeatures = VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT;
      break;
    default:
      break;
  }
}

inline VkResult get_image_format(VkPhysicalDevice, const VkPhysicalDeviceImageFormatInfo2* info,
                                 VkImageFormatProperties2* out) {
  VulkanMock& mock = *VulkanMock::current;
  if (const VkResult status = mock.next()) return status;
  const auto* wanted = find_in_chain<VkPhysicalDeviceExternalImageFormatInfo>(
      info->pNext, VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_IMAGE_FORMAT_INFO);
  auto* external = find_in_chain<VkExternalImageFormatProperties>(
      out->pNext, VK_STRUCTURE_TYPE_EXTERNAL_IMAGE_FORMAT_PROPERTIES);
  EXPECT_NE(wanted, nullptr);
  EXPECT_NE(external, nullptr);
  EXPECT_EQ(wanted->handleType, VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT);
  if (info->format == mock.device.not_shared) return VK_ERROR_FORMAT_NOT_SUPPORTED;
  if (info->format != mock.device.not_exported)
    external->externalMemoryProperties.externalMemoryFeatures =
        VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT;
  return VK_SUCCESS;
}

inline void get_external_buffers(VkPhysicalDevice, const VkPhysicalDeviceExternalBufferInfo* info,
                                 VkExternalBufferProperties* out) {
  EXPECT_EQ(info->handleType, VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT);
  if (VulkanMock::current->device.exports_buffers)
    out->externalMemoryProperties.externalMemoryFeatures =
        VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT;
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
