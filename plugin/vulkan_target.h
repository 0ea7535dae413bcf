#pragma once
#include <vector>

#include "plugin/objects.h"
#include "plugin/result.h"

namespace voyager {

// A target whose images are a Vulkan host's. desc: of kind VULKAN; checked here. It works with
// copies of the descriptors that the host passed: these are to be closed once the call has
// succeeded, and with it become the library's.
std::shared_ptr<TargetObject> create_vulkan_target(const std::shared_ptr<DeviceObject>& owner,
                                                   const VoyTargetDesc& desc,
                                                   const VoyVulkanTargetDesc* images,
                                                   std::vector<int>& passed);
void close_all(const std::vector<int>& descriptors) noexcept;

ColorFormat format_of(VoyColorFormat format);

inline vulkan::Ring& vulkan_ring(const TargetObject& target) {
  if (target.ring == nullptr) refuse("target: found kind HOST_MEMORY, expected kind VULKAN");
  return *target.ring;
}

}  // namespace voyager
