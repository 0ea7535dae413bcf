#pragma once
// The swapchains that both eyes are shown from: one with two layers where the eyes are of one
// size, else one an eye; and the same for depth, where the compositor takes it.
#include <array>

#include "formats.h"
#include "session.h"
#include "xr_swapchain.h"

namespace host {

struct EyeImage {
  Swapchain* colour;
  Swapchain* depth;  // or NULL
  uint32_t layer;
  VkExtent2D extent;
};

class EyeImages {
 public:
  // largest: pixels a side that Voyager can draw. readable: the images can be copied from.
  EyeImages(const Session& session, const Runtime& runtime, const Graphics& graphics,
            VkExtent2D largest, bool readable);
  EyeImages(const EyeImages&) = delete;
  EyeImages& operator=(const EyeImages&) = delete;

  ColourFormat colour_format() const { return colour_format_; }
  std::optional<VkFormat> depth_format() const { return depth_format_; }
  const EyeImage& eye(size_t i) const { return eyes_[i]; }
  std::array<VkExtent2D, kEyes> extents() const { return {eyes_[0].extent, eyes_[1].extent}; }

  bool ready(XrDuration patience);
  void release();

 private:
  bool create(const Session& session, const Graphics& graphics, bool array,
              const SwapchainDesc& desc, std::vector<Swapchain>& into) const;

  ColourFormat colour_format_;
  std::optional<VkFormat> depth_format_;
  std::array<EyeImage, kEyes> eyes_ = {};
  std::vector<Swapchain> colours_, depths_;
};

}  // namespace host
