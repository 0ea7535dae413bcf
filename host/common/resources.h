#pragma once
// Images and buffers with their memory.
#include <cstddef>
#include <span>

#include "gpu.h"
#include "unique.h"

namespace host {

struct Image {
  Image() = default;
  // A colour or depth attachment that can be copied from; `aspect` is its view's.
  Image(const Gpu& gpu, VkExtent2D extent, VkFormat format, VkImageUsageFlags usage,
        VkImageAspectFlags aspect);

  UniqueMemory memory;
  UniqueImage image;
  UniqueImageView view;
};

struct Buffer {
  Buffer() = default;
  // Mapped for as long as it lives, and coherent.
  Buffer(const Gpu& gpu, VkDeviceSize size, VkBufferUsageFlags usage);
  // With these contents.
  Buffer(const Gpu& gpu, std::span<const std::byte> bytes, VkBufferUsageFlags usage);

  UniqueMemory memory;
  UniqueBuffer buffer;
  std::byte* mapped = nullptr;
  VkDeviceSize size = 0;
};

}  // namespace host
