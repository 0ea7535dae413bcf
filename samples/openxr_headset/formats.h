#pragma once
// Which of a runtime's swapchain formats this program draws into. An _SRGB format holds code
// values; to a compositor all others hold linear light.
#include <vector>

#include "graphics.h"

namespace host {

struct ColourFormat {
  VkFormat format;
  const char* name;
};

// Of those that are offered, in any order, the best first: _SRGB ones of 8 bits, then wide linear
// ones, then linear ones of 8 bits, whose darks have fewer steps. Throws Failure where none is
// known.
std::vector<ColourFormat> usable_colours(const Graphics& graphics,
                                         const std::vector<int64_t>& offered);
// The most precise first; none where none is known.
std::vector<VkFormat> usable_depths(const Graphics& graphics, const std::vector<int64_t>& offered);
VkImageAspectFlags depth_aspects(VkFormat format);

}  // namespace host
