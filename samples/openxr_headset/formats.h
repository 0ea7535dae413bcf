#pragma once
// Which of a runtime's swapchain formats this program draws into. An _SRGB format holds code
// values; to a compositor all others hold linear light.
#include <optional>
#include <vector>

#include "graphics.h"

namespace host {

struct ColourFormat {
  VkFormat format;
  const char* name;
};

// Of those that are offered, in any order: an _SRGB one of 8 bits, else a wide linear one, else
// a linear one of 8 bits, whose darks have fewer steps. Throws Failure where none is known.
ColourFormat choose_colour(const Graphics& graphics, const std::vector<int64_t>& offered);
// The most precise; none where none is known.
std::optional<VkFormat> choose_depth(const Graphics& graphics, const std::vector<int64_t>& offered);
VkImageAspectFlags depth_aspects(VkFormat format);

}  // namespace host
