#include "creation.h"

#include <algorithm>
#include <voyager/voyager.hpp>

namespace host {

InstanceCreation::InstanceCreation(const char* name, Validation* validation,
                                   const std::vector<const char*>& own_extensions)
    : extensions_(own_extensions) {
  VoyVulkanRequirements needs = VOY_VULKAN_REQUIREMENTS_INIT;
  voy::check(voyGetVulkanRequirements(nullptr, &needs));
  extensions_.insert(extensions_.end(), needs.instanceExtensions,
                     needs.instanceExtensions + needs.instanceExtensionCount);
  application_.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  application_.pApplicationName = name;
  application_.apiVersion = std::max<uint32_t>(needs.vulkanVersion, VK_API_VERSION_1_1);
  info_.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
  info_.pApplicationInfo = &application_;
  if (validation) {
    require_validation_layer();
    extensions_.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    extensions_.push_back(VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME);
    info_.pNext = validation->instance_chain();
    info_.enabledLayerCount = 1;
    info_.ppEnabledLayerNames = &kValidationLayer;
  }
  info_.enabledExtensionCount = static_cast<uint32_t>(extensions_.size());
  info_.ppEnabledExtensionNames = extensions_.data();
}

DeviceCreation::DeviceCreation(VkInstance instance, uint32_t api_version, VkPhysicalDevice physical,
                               uint32_t queue_family,
                               const std::vector<const char*>& own_extensions)
    : extensions_(own_extensions) {
  VoyVulkanPhysicalDevice asked = VOY_VULKAN_PHYSICAL_DEVICE_INIT;
  asked.getInstanceProcAddr = vkGetInstanceProcAddr;
  asked.instance = instance;
  asked.physicalDevice = physical;
  VoyVulkanRequirements needs = VOY_VULKAN_REQUIREMENTS_INIT;
  voy::check(voyGetVulkanRequirements(&asked, &needs));
  extensions_.insert(extensions_.end(), needs.deviceExtensions,
                     needs.deviceExtensions + needs.deviceExtensionCount);

  queue_.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
  queue_.queueFamilyIndex = queue_family;
  queue_.queueCount = 1;
  queue_.pQueuePriorities = &priority_;
  timeline_.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES;
  timeline_.timelineSemaphore = VK_TRUE;
  info_.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
  if (needs.timelineSemaphore) info_.pNext = &timeline_;
  info_.queueCreateInfoCount = 1;
  info_.pQueueCreateInfos = &queue_;
  info_.enabledExtensionCount = static_cast<uint32_t>(extensions_.size());
  info_.ppEnabledExtensionNames = extensions_.data();

  desc_.getInstanceProcAddr = vkGetInstanceProcAddr;
  desc_.instance = instance;
  desc_.physicalDevice = physical;
  desc_.vulkanVersion = api_version;
  desc_.deviceExtensionCount = info_.enabledExtensionCount;
  desc_.deviceExtensions = extensions_.data();
  desc_.timelineSemaphore = needs.timelineSemaphore;
}

VoyVulkanDeviceDesc DeviceCreation::voyager_desc(VkDevice device) const {
  VoyVulkanDeviceDesc desc = desc_;
  desc.device = device;
  return desc;
}

}  // namespace host
