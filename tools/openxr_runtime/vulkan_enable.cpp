#include <vector>

#include "instance.h"

using namespace test_runtime;

namespace test_runtime {
namespace {

template <class Function>
Function find(PFN_vkGetInstanceProcAddr get, VkInstance instance, const char* name) {
  const auto function = reinterpret_cast<Function>(get(instance, name));
  if (!function)
    violation(XR_ERROR_VALIDATION_FAILURE,
              std::string("pfnGetInstanceProcAddr: found no ") + name + " through it");
  return function;
}

// GPUs before what computes on the CPU.
int rank(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 4;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 3;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
      return 1;
    default:
      return 0;
  }
}

VkPhysicalDevice best_device(const Instance& instance) {
  const auto enumerate_devices = find<PFN_vkEnumeratePhysicalDevices>(
      instance.vulkan_get, instance.vulkan_instance, "vkEnumeratePhysicalDevices");
  const auto properties_of = find<PFN_vkGetPhysicalDeviceProperties>(
      instance.vulkan_get, instance.vulkan_instance, "vkGetPhysicalDeviceProperties");
  uint32_t count = 0;
  enumerate_devices(instance.vulkan_instance, &count, nullptr);
  std::vector<VkPhysicalDevice> devices(count);
  enumerate_devices(instance.vulkan_instance, &count, devices.data());
  VkPhysicalDevice best = VK_NULL_HANDLE;
  int best_rank = -1;
  for (VkPhysicalDevice device : devices) {
    VkPhysicalDeviceProperties properties;
    properties_of(device, &properties);
    if (rank(properties.deviceType) <= best_rank) continue;
    best = device;
    best_rank = rank(properties.deviceType);
  }
  if (!best) refuse(XR_ERROR_RUNTIME_FAILURE, "found no Vulkan device");
  return best;
}

}  // namespace
}  // namespace test_runtime

XrResult xrGetVulkanGraphicsRequirements2KHR(XrInstance handle, XrSystemId system,
                                             XrGraphicsRequirementsVulkanKHR* requirements) {
  return call(__func__, [&](auto&) {
    Instance& instance = find_instance(handle);
    check_system(system);
    checked(requirements, XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN_KHR, "graphicsRequirements");
    requirements->minApiVersionSupported = run().script.vulkan[0];
    requirements->maxApiVersionSupported = run().script.vulkan[1];
    instance.requirements_asked = true;
    return XR_SUCCESS;
  });
}

XrResult xrCreateVulkanInstanceKHR(XrInstance handle, const XrVulkanInstanceCreateInfoKHR* info,
                                   VkInstance* vulkan_instance, VkResult* vulkan_result) {
  return call(__func__, [&](auto&) {
    Instance& instance = find_instance(handle);
    checked(info, XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR, "createInfo");
    check_system(info->systemId);
    if (info->createFlags != 0) violation(XR_ERROR_VALIDATION_FAILURE, "createFlags: expected 0");
    checked_pointer(info->vulkanCreateInfo, "vulkanCreateInfo");
    checked_pointer(info->pfnGetInstanceProcAddr, "pfnGetInstanceProcAddr");
    checked_pointer(vulkan_instance, "vulkanInstance");
    checked_pointer(vulkan_result, "vulkanResult");
    const auto create = find<PFN_vkCreateInstance>(info->pfnGetInstanceProcAddr, VK_NULL_HANDLE,
                                                   "vkCreateInstance");
    *vulkan_result = create(info->vulkanCreateInfo, info->vulkanAllocator, vulkan_instance);
    if (*vulkan_result != VK_SUCCESS) return XR_SUCCESS;
    instance.vulkan_instance = *vulkan_instance;
    instance.vulkan_get = info->pfnGetInstanceProcAddr;
    instance.vulkan_physical = VK_NULL_HANDLE;
    instance.vulkan_device = VK_NULL_HANDLE;
    return XR_SUCCESS;
  });
}

XrResult xrGetVulkanGraphicsDevice2KHR(XrInstance handle,
                                       const XrVulkanGraphicsDeviceGetInfoKHR* info,
                                       VkPhysicalDevice* device) {
  return call(__func__, [&](auto&) {
    Instance& instance = find_instance(handle);
    checked(info, XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR, "getInfo");
    check_system(info->systemId);
    checked_pointer(device, "vulkanPhysicalDevice");
    if (!instance.vulkan_instance || info->vulkanInstance != instance.vulkan_instance)
      violation(XR_ERROR_VALIDATION_FAILURE,
                "vulkanInstance: expected that of xrCreateVulkanInstanceKHR");
    if (!instance.vulkan_physical) instance.vulkan_physical = best_device(instance);
    *device = instance.vulkan_physical;
    return XR_SUCCESS;
  });
}

XrResult xrCreateVulkanDeviceKHR(XrInstance handle, const XrVulkanDeviceCreateInfoKHR* info,
                                 VkDevice* vulkan_device, VkResult* vulkan_result) {
  return call(__func__, [&](auto&) {
    Instance& instance = find_instance(handle);
    checked(info, XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR, "createInfo");
    check_system(info->systemId);
    if (info->createFlags != 0) violation(XR_ERROR_VALIDATION_FAILURE, "createFlags: expected 0");
    checked_pointer(info->vulkanCreateInfo, "vulkanCreateInfo");
    checked_pointer(info->pfnGetInstanceProcAddr, "pfnGetInstanceProcAddr");
    checked_pointer(vulkan_device, "vulkanDevice");
    checked_pointer(vulkan_result, "vulkanResult");
    if (!instance.vulkan_physical || info->vulkanPhysicalDevice != instance.vulkan_physical)
      violation(XR_ERROR_VALIDATION_FAILURE,
                "vulkanPhysicalDevice: expected that of xrGetVulkanGraphicsDevice2KHR");
    const auto create = find<PFN_vkCreateDevice>(info->pfnGetInstanceProcAddr,
                                                 instance.vulkan_instance, "vkCreateDevice");
    *vulkan_result = create(info->vulkanPhysicalDevice, info->vulkanCreateInfo,
                            info->vulkanAllocator, vulkan_device);
    if (*vulkan_result == VK_SUCCESS) instance.vulkan_device = *vulkan_device;
    return XR_SUCCESS;
  });
}
