#pragma once
// One swapchain of the runtime's: its images, and whose they are at a time.
#include "graphics.h"
#include "unique.h"

namespace host {

struct SwapchainDesc {
  VkFormat format;
  XrSwapchainUsageFlags usage;
  VkImageAspectFlags aspects;
  VkExtent2D extent;
  uint32_t layers;
};

class Swapchain {
 public:
  // Throws Failure where the runtime does not make such swapchains, or Lost.
  Swapchain(XrSession session, const Graphics& graphics, const SwapchainDesc& desc);

  XrSwapchain get() const { return swapchain_.get(); }
  VkExtent2D extent() const { return extent_; }
  uint32_t count() const { return static_cast<uint32_t>(images_.size()); }

  // True: an image is there to be written, and stays so until it is released. False: the
  // compositor still reads it; ask again in the next frame.
  bool ready(XrDuration patience);
  void release();

  // The image that is ready.
  uint32_t index() const { return index_; }
  VkImage image() const { return images_[index_]; }
  VkImageView view(uint32_t layer) const { return views_[index_ * layers_ + layer].get(); }

 private:
  void list_images(const Graphics& graphics, const SwapchainDesc& desc);

  enum class State { released, acquired, ready };

  UniqueXrSwapchain swapchain_;
  VkExtent2D extent_;
  uint32_t layers_, index_ = 0;
  State state_ = State::released;
  std::vector<VkImage> images_;
  std::vector<UniqueImageView> views_;  // one a layer
};

}  // namespace host
