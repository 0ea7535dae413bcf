#pragma once
// What the parts that samples share need to know of a host's device.
#include <vulkan/vulkan.h>

namespace host {

struct Gpu {
  VkPhysicalDevice physical;
  VkDevice device;
};

}  // namespace host
