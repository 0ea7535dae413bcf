#pragma once
#include "runtime/frame/image.h"
#include "vulkan_interop/functions.h"

namespace voyager::vulkan {

inline constexpr VkFormat kDepthFormat = VK_FORMAT_R32_SFLOAT;

constexpr VkFormat vk_format(ColorFormat format) {
  switch (format) {
    case ColorFormat::rgba8:
      return VK_FORMAT_R8G8B8A8_UNORM;
    case ColorFormat::rgba16f:
      return VK_FORMAT_R16G16B16A16_SFLOAT;
    case ColorFormat::rgba32f:
      return VK_FORMAT_R32G32B32A32_SFLOAT;
    case ColorFormat::none:
      break;
  }
  return VK_FORMAT_UNDEFINED;
}

// All that a ring's images may have.
inline constexpr VkFormat kRingFormats[] = {vk_format(ColorFormat::rgba8),
                                            vk_format(ColorFormat::rgba16f),
                                            vk_format(ColorFormat::rgba32f), kDepthFormat};

}  // namespace voyager::vulkan
