#pragma once
// The window's images. The host draws elsewhere and copies into them.
#include <array>
#include <vector>

#include "device.h"
#include "frames_in_flight.h"
#include "render_targets.h"

namespace host {

class Swapchain {
 public:
  Swapchain(const Device& device, VkSurfaceKHR surface);

  // What the host draws in so that a copy shows code values as they are: _UNORM, or _SRGB
  // where the surface has nothing else.
  VkFormat colour_format() const { return colour_format_; }
  VkExtent2D extent() const { return extent_; }

  // The queue must be idle. False: the window has no size now.
  bool resize(VkExtent2D wanted);
  // False: the window has changed, resize.
  bool acquire(uint32_t slot);
  VkSemaphore acquired(uint32_t slot) const { return acquired_[slot].get(); }
  VkSemaphore ready() const { return ready_[image_].get(); }
  void record(VkCommandBuffer commands, const RenderTargets& targets) const;
  bool present();  // as acquire

 private:
  const Device& device_;
  VkSurfaceKHR surface_;
  VkSurfaceFormatKHR format_ = {};
  VkFormat colour_format_ = VK_FORMAT_UNDEFINED;
  VkExtent2D extent_ = {0, 0};
  UniqueSwapchain swapchain_;
  std::vector<VkImage> images_;
  std::array<UniqueSemaphore, kFramesInFlight> acquired_;
  std::vector<UniqueSemaphore> ready_;  // one an image: a present may still wait for it
  uint32_t image_ = 0;
};

}  // namespace host
