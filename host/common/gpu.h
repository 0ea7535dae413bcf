#pragma once
// What the shared parts need to know of a host's device.
#include <vulkan/vulkan.h>

namespace host {

struct Gpu {
  VkPhysicalDevice physical;
  VkDevice device;
  VkQueue queue;  // the host's one queue
  uint32_t queue_family;
};

}  // namespace host
