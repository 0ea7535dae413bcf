#pragma once
// A host of the C ABI whose Vulkan is a mock.
#include "tests/support/vulkan_mock.h"
// Above: it declares Vulkan without prototypes.
#include <voyager/voyager_vulkan.h>

#include "tests/headless/host.h"
#include "tests/support/descriptor_watch.h"

inline VoyVulkanDeviceDesc vulkan_desc(const std::vector<const char*>& extensions) {
  VoyVulkanDeviceDesc desc = VOY_VULKAN_DEVICE_DESC_INIT;
  desc.getInstanceProcAddr = &voyager::test::VulkanMock::get_instance;
  desc.instance = voyager::test::VulkanMock::instance();
  desc.physicalDevice = voyager::test::VulkanMock::physical();
  desc.device = voyager::test::VulkanMock::handle();
  desc.vulkanVersion = VK_API_VERSION_1_2;
  desc.deviceExtensionCount = static_cast<uint32_t>(extensions.size());
  desc.deviceExtensions = extensions.data();
  desc.timelineSemaphore = VK_TRUE;
  return desc;
}

// Host's constructor takes it by value; the chain lives as long as the test.
inline VoyDeviceDesc cpu_with(const VoyVulkanDeviceDesc& vulkan) {
  VoyDeviceDesc desc = device_for(VOY_BACKEND_CPU);
  desc.next = &vulkan;
  return desc;
}
