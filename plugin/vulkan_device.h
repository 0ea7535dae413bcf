#pragma once
// A host's Vulkan device, as the ABI has it.
#include "plugin/objects.h"
#include "vulkan_interop/device.h"

namespace voyager {

// Checks what the host passed.
vulkan::DeviceDesc vulkan_device_desc(const VoyVulkanDeviceDesc& desc);

void fill(VoyVulkanCapabilities& out, const vulkan::Device& device);

}  // namespace voyager
