#pragma once
// A target of Voyager's with an image for each frame in flight, and what hands an image over. The
// order of a frame:
//   1. begin_frame(); commands A: record_release; their submission signals released()
//   2. voyRenderFrame with frame() in VoyFrame.next
//   3. commands B: record_acquire, then whatever samples the image in a fragment shader; their
//      submission waits for rendered()
#include <voyager/voyager_vulkan.h>

#include <vector>
#include <voyager/voyager.hpp>

#include "gpu.h"
#include "submission.h"

namespace host {

struct RingDesc {
  VkExtent2D extent = {0, 0};
  uint32_t images = 1;
  VkBool32 depth = VK_FALSE, depth_limit = VK_FALSE;
  uint32_t layers = 1;  // of each image
};

class VoyagerRing {
 public:
  VoyagerRing() = default;
  // Both devices must outlive it.
  VoyagerRing(const Gpu& gpu, const voy::Device& device, const RingDesc& desc);

  explicit operator bool() const { return static_cast<bool>(target_); }
  VoyTarget target() const { return target_.get(); }
  VkExtent2D extent() const { return desc_.extent; }
  const VoyVulkanImage& image(uint32_t index) const { return images_[index]; }
  // With VOY_VULKAN_SYNC_HOST the host waits until commands A are done, before it renders.
  bool host_waits() const { return sync_ == VOY_VULKAN_SYNC_HOST; }

  void begin_frame() { ++frame_; }
  // Both are NULL with VOY_VULKAN_SYNC_HOST.
  SemaphoreUse released(uint32_t index) const { return {images_[index].released, timeline()}; }
  SemaphoreUse rendered(uint32_t index) const { return {images_[index].rendered, timeline()}; }
  VoyVulkanFrame frame(uint32_t index) const;
  void record_release(VkCommandBuffer commands, uint32_t index) const;
  void record_acquire(VkCommandBuffer commands, uint32_t index) const;

 private:
  VoyVulkanUse use(VkCommandBuffer commands, uint32_t index) const;
  uint64_t timeline() const { return sync_ == VOY_VULKAN_SYNC_TIMELINE ? frame_ : 0; }

  RingDesc desc_;
  uint32_t queue_family_ = 0;
  VoyVulkanSync sync_ = VOY_VULKAN_SYNC_HOST;
  voy::Target target_;
  std::vector<VoyVulkanImage> images_;
  uint64_t frame_ = 0;  // from 1: what its timeline semaphores count
};

}  // namespace host
