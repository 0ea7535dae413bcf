#pragma once
// The swapchains that both eyes are shown from: one with two layers where the eyes are of one
// size, else one an eye; and the same for depth, where the compositor takes it.
#include <array>
#include <optional>

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
  void create_colours(const Session& session, const Graphics& graphics,
                      const std::vector<ColourFormat>& formats, bool readable);
  void create_depths(const Session& session, const Graphics& graphics,
                     const std::vector<VkFormat>& formats);
  bool create(const Session& session, const Graphics& graphics, const SwapchainDesc& desc,
              std::vector<Swapchain>& into);

  ColourFormat colour_format_ = {};
  std::optional<VkFormat> depth_format_;
  std::array<EyeImage, kEyes> eyes_ = {};
  std::vector<Swapchain> colours_, depths_;
  bool array_ = false;   // one swapchain, a layer an eye
  std::string refusal_;  // why the last ones were not made
};

}  // namespace host
