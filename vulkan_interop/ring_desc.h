#pragma once
// What a ring of images is made from: the host's wishes, and what it passes of its own.
#include <vector>

#include "runtime/frame/image.h"
#include "vulkan_interop/functions.h"

namespace voyager::vulkan {

// The host's memory by descriptor; this side makes a copy of the descriptor.
struct ImportedMemory {
  int fd = -1;
  uint64_t size = 0, offset = 0;
  bool dedicated = false;
};
struct ImportedImage {
  VkImage color = VK_NULL_HANDLE, depth = VK_NULL_HANDLE;
  ImportedMemory color_memory, depth_memory;
  VkImageUsageFlags color_usage = 0, depth_usage = 0;
};
struct ImportedSemaphores {
  VkSemaphore released = VK_NULL_HANDLE, rendered = VK_NULL_HANDLE;
  int released_fd = -1, rendered_fd = -1;
};

struct RingDesc {
  ColorFormat format = ColorFormat::none;
  uint32_t width = 0, height = 0, images = 0, layers = 1;
  bool depth = false, depth_limit = false;
  std::vector<ImportedImage> imported;         // none, or one an image
  std::vector<ImportedSemaphores> semaphores;  // none, or one (timelines) or one an image
};

}  // namespace voyager::vulkan
