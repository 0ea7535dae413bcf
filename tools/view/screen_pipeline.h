#pragma once
// Draws what Voyager drew over all of an attachment: one picture, or two beside a line.
#include "frames_in_flight.h"
#include "gpu.h"
#include "sampled_images.h"

namespace voyager::view {

struct Screen {
  VkImageView left = VK_NULL_HANDLE, right = VK_NULL_HANDLE;  // 2D arrays
  float split = 0;     // pixels from the left, where the right picture begins
  float exposure = 1;  // factor of light
};

class ScreenPipeline {
 public:
  ScreenPipeline(const host::Gpu& gpu, VkRenderPass pass, VkFormat colour);

  // In the pass. The slot's frame before must be done.
  void record(VkCommandBuffer commands, uint32_t slot, VkExtent2D extent, const Screen& screen);

 private:
  host::SampledImages sets_;  // one a slot
  host::UniquePipelineLayout layout_;
  host::UniquePipeline pipeline_;
};

}  // namespace voyager::view
