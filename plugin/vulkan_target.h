#pragma once
#include "plugin/objects.h"
#include "plugin/result.h"

namespace voyager {

// A target whose images are a Vulkan host's. desc: of kind VULKAN; checked here.
std::shared_ptr<TargetObject> create_vulkan_target(std::shared_ptr<DeviceObject> owner,
                                                   const VoyTargetDesc& desc,
                                                   const VoyVulkanTargetDesc* images);

ColorFormat format_of(VoyColorFormat format);

inline vulkan::Ring& vulkan_ring(const TargetObject& target) {
  if (target.ring == nullptr) refuse("target: found one of HOST_MEMORY, expected one of VULKAN");
  return *target.ring;
}

}  // namespace voyager
