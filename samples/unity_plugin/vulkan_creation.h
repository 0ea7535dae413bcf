#pragma once
// Unity makes the VkInstance and the VkDevice. This adds what voyGetVulkanRequirements names to
// both, and remembers what they were made with.
#include <voyager/voyager_vulkan.h>

#include "unity_interfaces.h"

namespace voyager_unity {

// For IUnityGraphicsVulkan::InterceptInitialization, before Unity initialises Vulkan. If Vulkan
// refuses the additions, the object is made as Unity asked for it.
PFN_vkGetInstanceProcAddr UNITY_INTERFACE_API intercept_creation(PFN_vkGetInstanceProcAddr next,
                                                                 void* unused);

// What voyCreateDevice needs to know of Unity's device. False if the device was made without
// interception. The pointers stay valid until another device is made.
bool describe(const UnityVulkanInstance& unity, VoyVulkanDeviceDesc* desc);

// Before the plugin is unloaded: handles of another device may have the same value.
void forget_device();

}  // namespace voyager_unity
