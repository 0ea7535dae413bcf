#include "vulkan_creation.h"

#include <algorithm>
#include <cstring>
#include <string>
#include <vector>

namespace voyager_unity {
namespace {

// Unity makes one instance and one device at a time, on one thread.
struct Created {
  PFN_vkGetInstanceProcAddr next = nullptr;
  VkInstance instance = VK_NULL_HANDLE;
  uint32_t api_version = 0;
  VkDevice device = VK_NULL_HANDLE;
  std::vector<std::string> extensions;
  std::vector<const char*> extension_names;  // of `extensions`
  VkBool32 timelines = VK_FALSE;
};
Created created;

using Names = std::vector<const char*>;

Names with(const char* const* own, uint32_t own_count, const char* const* added,
           uint32_t added_count) {
  Names names(own, own + own_count);
  for (uint32_t i = 0; i < added_count; ++i)
    if (std::none_of(names.begin(), names.end(),
                     [&](const char* name) { return std::strcmp(name, added[i]) == 0; }))
      names.push_back(added[i]);
  return names;
}

VKAPI_ATTR VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo* own,
                                               const VkAllocationCallbacks* allocator,
                                               VkInstance* instance) {
  const auto create =
      reinterpret_cast<PFN_vkCreateInstance>(created.next(nullptr, "vkCreateInstance"));
  VoyVulkanRequirements needs = VOY_VULKAN_REQUIREMENTS_INIT;
  voyGetVulkanRequirements(nullptr, &needs);
  VkApplicationInfo application = {};
  application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
  if (own->pApplicationInfo) application = *own->pApplicationInfo;
  const uint32_t own_version = application.apiVersion;
  application.apiVersion = std::max(own_version, needs.vulkanVersion);
  const Names extensions = with(own->ppEnabledExtensionNames, own->enabledExtensionCount,
                                needs.instanceExtensions, needs.instanceExtensionCount);
  VkInstanceCreateInfo info = *own;
  info.pApplicationInfo = &application;
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  created.api_version = application.apiVersion;
  VkResult result = create(&info, allocator, instance);
  if (result != VK_SUCCESS) {
    created.api_version = own_version;
    result = create(own, allocator, instance);
  }
  created.instance = result == VK_SUCCESS ? *instance : VK_NULL_HANDLE;
  return result;
}

// The feature in Unity's own chain, which must not get a second structure for it. NULL if the
// chain has none.
VkBool32* timeline_feature(const void* chain) {
  auto* found = static_cast<VkBaseOutStructure*>(const_cast<void*>(chain));
  for (; found; found = found->pNext) {
    if (found->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES)
      return &reinterpret_cast<VkPhysicalDeviceTimelineSemaphoreFeatures*>(found)
                  ->timelineSemaphore;
    if (found->sType == VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES)
      return &reinterpret_cast<VkPhysicalDeviceVulkan12Features*>(found)->timelineSemaphore;
  }
  return nullptr;
}

void remember(VkDevice device, const Names& extensions, VkBool32 timelines) {
  created.device = device;
  created.timelines = timelines;
  created.extensions.assign(extensions.begin(), extensions.end());
  created.extension_names.clear();
  for (const std::string& name : created.extensions)
    created.extension_names.push_back(name.c_str());
}

VkResult create_with(PFN_vkCreateDevice create, VkPhysicalDevice physical,
                     const VoyVulkanRequirements& needs, const VkDeviceCreateInfo& own,
                     const VkAllocationCallbacks* allocator, VkDevice* device) {
  const Names extensions = with(own.ppEnabledExtensionNames, own.enabledExtensionCount,
                                needs.deviceExtensions, needs.deviceExtensionCount);
  VkDeviceCreateInfo info = own;
  info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
  info.ppEnabledExtensionNames = extensions.data();
  VkPhysicalDeviceTimelineSemaphoreFeatures added = {};
  added.sType = VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES;
  added.pNext = const_cast<void*>(own.pNext);
  added.timelineSemaphore = VK_TRUE;
  VkBool32* feature = timeline_feature(own.pNext);
  const VkBool32 asked = feature ? *feature : VK_FALSE;
  if (feature)
    *feature = asked | needs.timelineSemaphore;
  else if (needs.timelineSemaphore)
    info.pNext = &added;
  const VkResult result = create(physical, &info, allocator, device);
  if (feature) *feature = asked;
  if (result == VK_SUCCESS) remember(*device, extensions, asked | needs.timelineSemaphore);
  return result;
}

VKAPI_ATTR VkResult VKAPI_CALL create_device(VkPhysicalDevice physical,
                                             const VkDeviceCreateInfo* own,
                                             const VkAllocationCallbacks* allocator,
                                             VkDevice* device) {
  const auto create =
      reinterpret_cast<PFN_vkCreateDevice>(created.next(created.instance, "vkCreateDevice"));
  VoyVulkanPhysicalDevice asked = VOY_VULKAN_PHYSICAL_DEVICE_INIT;
  asked.getInstanceProcAddr = created.next;
  asked.instance = created.instance;
  asked.physicalDevice = physical;
  VoyVulkanRequirements needs = VOY_VULKAN_REQUIREMENTS_INIT;
  if (voyGetVulkanRequirements(&asked, &needs) == VOY_SUCCESS &&
      create_with(create, physical, needs, *own, allocator, device) == VK_SUCCESS)
    return VK_SUCCESS;
  const VoyVulkanRequirements nothing = VOY_VULKAN_REQUIREMENTS_INIT;
  return create_with(create, physical, nothing, *own, allocator, device);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL get_instance_proc_addr(VkInstance instance,
                                                                const char* name) {
  if (std::strcmp(name, "vkGetInstanceProcAddr") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(get_instance_proc_addr);
  if (std::strcmp(name, "vkCreateInstance") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(create_instance);
  if (std::strcmp(name, "vkCreateDevice") == 0)
    return reinterpret_cast<PFN_vkVoidFunction>(create_device);
  return created.next(instance, name);
}

}  // namespace

PFN_vkGetInstanceProcAddr UNITY_INTERFACE_API intercept_creation(PFN_vkGetInstanceProcAddr next,
                                                                 void*) {
  created.next = next;
  return get_instance_proc_addr;
}

bool describe(const UnityVulkanInstance& unity, VoyVulkanDeviceDesc* desc) {
  if (!created.device || created.device != unity.device) return false;
  *desc = VOY_VULKAN_DEVICE_DESC_INIT;
  desc->getInstanceProcAddr = created.next;
  desc->instance = unity.instance;
  desc->physicalDevice = unity.physicalDevice;
  desc->device = unity.device;
  desc->vulkanVersion = created.api_version;
  desc->deviceExtensionCount = static_cast<uint32_t>(created.extension_names.size());
  desc->deviceExtensions = created.extension_names.data();
  desc->timelineSemaphore = created.timelines;
  return true;
}

void forget_device() {
  created = {};
}

}  // namespace voyager_unity
