#include "vulkan_interop/physical_device.h"

#include <algorithm>
#include <vector>

#include "runtime/base/error.h"

namespace voyager::vulkan {
namespace {

std::string version_text(uint32_t version) {
  return std::to_string(VK_API_VERSION_MAJOR(version)) + "." +
         std::to_string(VK_API_VERSION_MINOR(version));
}

std::set<std::string> extensions_of(const InstanceFunctions& vk, VkPhysicalDevice device) {
  uint32_t count = 0;
  check(vk.EnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr), "extensions");
  std::vector<VkExtensionProperties> found(count);
  check(vk.EnumerateDeviceExtensionProperties(device, nullptr, &count, found.data()), "extensions");
  found.resize(count);
  std::set<std::string> names;
  for (const VkExtensionProperties& extension : found) names.insert(extension.extensionName);
  return names;
}

}  // namespace

PhysicalDevice::PhysicalDevice(PFN_vkGetInstanceProcAddr get, VkInstance instance,
                               VkPhysicalDevice device)
    : vk_(load_instance_functions(get, instance)), device_(device) {
  VkPhysicalDeviceExternalMemoryHostPropertiesEXT host_memory{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_MEMORY_HOST_PROPERTIES_EXT, nullptr, 0};
  VkPhysicalDeviceIDProperties identity{};
  identity.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES;
  VkPhysicalDeviceProperties2 properties{};
  properties.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2;
  extensions_ = extensions_of(vk_, device);
  properties.pNext = &identity;
  if (has(VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME)) identity.pNext = &host_memory;
  vk_.GetPhysicalDeviceProperties2(device, &properties);
  version_ = properties.properties.apiVersion;
  if (version_ < kLeastVersion)
    throw Error(ErrorCode::unsupported, std::string("Vulkan: ") + properties.properties.deviceName +
                                            ": found version " + version_text(version_) +
                                            ", expected " + version_text(kLeastVersion) +
                                            " or newer");
  std::copy_n(identity.deviceUUID, uuid_.size(), uuid_.begin());
  host_pointer_alignment_ = host_memory.minImportedHostPointerAlignment;
  vk_.GetPhysicalDeviceMemoryProperties(device, &memory_);
  vk_.GetPhysicalDeviceQueueFamilyProperties(device, &queue_families_, nullptr);
  if (version_ < VK_API_VERSION_1_2 && !has(VK_KHR_TIMELINE_SEMAPHORE_EXTENSION_NAME)) return;
  VkPhysicalDeviceTimelineSemaphoreFeatures timelines{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES, nullptr, VK_FALSE};
  VkPhysicalDeviceFeatures2 features{};
  features.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2;
  features.pNext = &timelines;
  vk_.GetPhysicalDeviceFeatures2(device, &features);
  timelines_ = timelines.timelineSemaphore != VK_FALSE;
}

bool PhysicalDevice::exports_images(VkFormat format) const {
  const VkPhysicalDeviceExternalImageFormatInfo external{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_IMAGE_FORMAT_INFO, nullptr,
      VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT};
  VkPhysicalDeviceImageFormatInfo2 info{};
  info.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_IMAGE_FORMAT_INFO_2;
  info.pNext = &external;
  info.format = format;
  info.type = VK_IMAGE_TYPE_2D;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = kImageUsage;
  VkExternalImageFormatProperties shared{};
  shared.sType = VK_STRUCTURE_TYPE_EXTERNAL_IMAGE_FORMAT_PROPERTIES;
  VkImageFormatProperties2 found{};
  found.sType = VK_STRUCTURE_TYPE_IMAGE_FORMAT_PROPERTIES_2;
  found.pNext = &shared;
  const VkResult status = vk_.GetPhysicalDeviceImageFormatProperties2(device_, &info, &found);
  if (status == VK_ERROR_FORMAT_NOT_SUPPORTED) return false;
  check(status, "vkGetPhysicalDeviceImageFormatProperties2");
  return (shared.externalMemoryProperties.externalMemoryFeatures &
          VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT) != 0;
}

bool PhysicalDevice::exports_buffers() const {
  const VkPhysicalDeviceExternalBufferInfo info{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_BUFFER_INFO, nullptr, 0, kBufferUsage,
      VK_EXTERNAL_MEMORY_HANDLE_TYPE_OPAQUE_FD_BIT};
  VkExternalBufferProperties found{};
  found.sType = VK_STRUCTURE_TYPE_EXTERNAL_BUFFER_PROPERTIES;
  vk_.GetPhysicalDeviceExternalBufferProperties(device_, &info, &found);
  return (found.externalMemoryProperties.externalMemoryFeatures &
          VK_EXTERNAL_MEMORY_FEATURE_EXPORTABLE_BIT) != 0;
}

bool PhysicalDevice::draws_to(VkFormat format, VkFormatFeatureFlags features) const {
  VkFormatProperties found{};
  vk_.GetPhysicalDeviceFormatProperties(device_, format, &found);
  return (found.optimalTilingFeatures & features) == features;
}

bool PhysicalDevice::exports_semaphores(bool timeline) const {
  if (timeline && !timelines_) return false;
  const VkSemaphoreTypeCreateInfo type{
      VK_STRUCTURE_TYPE_SEMAPHORE_TYPE_CREATE_INFO, nullptr,
      timeline ? VK_SEMAPHORE_TYPE_TIMELINE : VK_SEMAPHORE_TYPE_BINARY, 0};
  const VkPhysicalDeviceExternalSemaphoreInfo info{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_SEMAPHORE_INFO, timeline ? &type : nullptr,
      VK_EXTERNAL_SEMAPHORE_HANDLE_TYPE_OPAQUE_FD_BIT};
  VkExternalSemaphoreProperties found{};
  found.sType = VK_STRUCTURE_TYPE_EXTERNAL_SEMAPHORE_PROPERTIES;
  vk_.GetPhysicalDeviceExternalSemaphoreProperties(device_, &info, &found);
  return (found.externalSemaphoreFeatures & VK_EXTERNAL_SEMAPHORE_FEATURE_EXPORTABLE_BIT) != 0;
}

}  // namespace voyager::vulkan
