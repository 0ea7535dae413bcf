#include "formats.h"

#include <algorithm>

namespace host {
namespace {

constexpr ColourFormat kColours[] = {
    {VK_FORMAT_R8G8B8A8_SRGB, "R8G8B8A8_SRGB"},
    {VK_FORMAT_B8G8R8A8_SRGB, "B8G8R8A8_SRGB"},
    {VK_FORMAT_A8B8G8R8_SRGB_PACK32, "A8B8G8R8_SRGB"},
    {VK_FORMAT_R16G16B16A16_SFLOAT, "R16G16B16A16_SFLOAT"},
    {VK_FORMAT_R16G16B16A16_UNORM, "R16G16B16A16_UNORM"},
    {VK_FORMAT_R32G32B32A32_SFLOAT, "R32G32B32A32_SFLOAT"},
    {VK_FORMAT_B10G11R11_UFLOAT_PACK32, "B10G11R11_UFLOAT"},
    {VK_FORMAT_A2B10G10R10_UNORM_PACK32, "A2B10G10R10_UNORM"},
    {VK_FORMAT_A2R10G10B10_UNORM_PACK32, "A2R10G10B10_UNORM"},
    {VK_FORMAT_R8G8B8A8_UNORM, "R8G8B8A8_UNORM"},
    {VK_FORMAT_B8G8R8A8_UNORM, "B8G8R8A8_UNORM"},
    {VK_FORMAT_A8B8G8R8_UNORM_PACK32, "A8B8G8R8_UNORM"},
};
constexpr VkFormat kDepths[] = {VK_FORMAT_D32_SFLOAT, VK_FORMAT_D32_SFLOAT_S8_UINT,
                                VK_FORMAT_D24_UNORM_S8_UINT, VK_FORMAT_X8_D24_UNORM_PACK32,
                                VK_FORMAT_D16_UNORM};

bool usable(const Graphics& graphics, const std::vector<int64_t>& offered, VkFormat format,
            VkFormatFeatureFlags needed) {
  if (std::find(offered.begin(), offered.end(), int64_t{format}) == offered.end()) return false;
  VkFormatProperties properties;
  vkGetPhysicalDeviceFormatProperties(graphics.physical(), format, &properties);
  return (properties.optimalTilingFeatures & needed) == needed;
}

}  // namespace

std::vector<ColourFormat> usable_colours(const Graphics& graphics,
                                         const std::vector<int64_t>& offered) {
  std::vector<ColourFormat> colours;
  for (const ColourFormat& colour : kColours)
    if (usable(graphics, offered, colour.format, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT))
      colours.push_back(colour);
  if (!colours.empty()) return colours;
  std::string found;
  for (const int64_t format : offered)
    found += (found.empty() ? "" : ", ") + std::to_string(format);
  throw Failure(kMachine, "swapchain formats: found " + (found.empty() ? "none" : found) +
                              " (VkFormat), expected a colour format of three channels or more");
}

std::vector<VkFormat> usable_depths(const Graphics& graphics, const std::vector<int64_t>& offered) {
  std::vector<VkFormat> depths;
  for (const VkFormat format : kDepths)
    if (usable(graphics, offered, format, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT))
      depths.push_back(format);
  return depths;
}

VkImageAspectFlags depth_aspects(VkFormat format) {
  const bool stencil =
      format == VK_FORMAT_D32_SFLOAT_S8_UINT || format == VK_FORMAT_D24_UNORM_S8_UINT;
  return VK_IMAGE_ASPECT_DEPTH_BIT | (stencil ? VK_IMAGE_ASPECT_STENCIL_BIT : 0);
}

}  // namespace host
