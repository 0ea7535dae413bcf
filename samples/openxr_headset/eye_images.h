#pragma once
// The swapchains that the eyes are shown from: for each pair of views, left and right, one with two
// layers where the views of every pair are of one size, else one a view; and the same for depth,
// where the compositor takes it.
#include <optional>
#include <vector>

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
  size_t view_count() const { return views_.size(); }
  const EyeImage& view(size_t i) const { return views_[i]; }
  std::vector<VkExtent2D> extents() const;

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
  std::vector<EyeImage> views_;
  std::vector<Swapchain> colours_, depths_;
  bool array_ = false;   // a swapchain of two layers a pair
  std::string refusal_;  // why the last ones were not made
};

}  // namespace host
