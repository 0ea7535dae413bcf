#pragma once
// Voyager in this headset: the part to copy. It owns a device, a scene, a view of two eyes, and
// a target whose ring has an image for each frame in flight, with a layer for each eye. The
// order of a frame:
//   1. commands A: record_release; their submission signals released()
//   2. render()
//   3. commands B: record_acquire, then draws that sample the image; their submission waits for
//      rendered()
#include <array>
#include <string>
#include <voyager/voyager.hpp>

#include "camera.h"
#include "graphics.h"
#include "submission.h"

namespace host {

inline constexpr uint32_t kFramesInFlight = 2;

class VoyagerLayer {
 public:
  // Throws Failure where the library draws no stereo.
  VoyagerLayer(const Graphics& graphics, const std::string& scene, double tau);

  const VoyCapabilities& capabilities() const { return capabilities_; }
  const VoyVulkanCapabilities& vulkan_capabilities() const { return vulkan_; }
  const voy::Device& device() const { return device_; }
  const voy::Scene& scene() const { return scene_; }
  double tau() const { return tau_; }
  VkExtent2D largest() const { return {capabilities_.maxWidth, capabilities_.maxHeight}; }

  // The queue must be idle: the target's images are replaced.
  void resize(VkExtent2D extent, bool depth);
  // What the draws sample: arrays with a layer for each eye.
  const VoyVulkanImage& image(uint32_t slot) const { return ring_[slot]; }

  void begin_frame() { ++frame_; }  // before the semaphores of this frame are asked for
  void record_release(VkCommandBuffer commands, uint32_t slot) const;
  SemaphoreUse released(uint32_t slot) const;
  // With VOY_VULKAN_SYNC_HOST the host has waited until commands A are done. An eye that is
  // smaller than the target is drawn into its upper left part.
  void render(const std::array<Camera, kEyes>& eyes, double near_z, uint32_t slot);
  SemaphoreUse rendered(uint32_t slot) const;
  void record_acquire(VkCommandBuffer commands, uint32_t slot) const;

  bool host_waits() const { return vulkan_.sync == VOY_VULKAN_SYNC_HOST; }

 private:
  void create_device();
  void create_view(VkExtent2D largest);
  VoyVulkanUse use(VkCommandBuffer commands, uint32_t slot) const;
  VoyFrustum widened(const Camera& eye) const;
  uint64_t timeline_value() const;

  const Graphics& graphics_;
  const double tau_;
  voy::Device device_;
  VoyCapabilities capabilities_ = VOY_CAPABILITIES_INIT;
  VoyVulkanCapabilities vulkan_ = VOY_VULKAN_CAPABILITIES_INIT;
  voy::Scene scene_;
  voy::View view_;
  VkExtent2D view_extent_ = {0, 0};
  voy::Target target_;
  VkExtent2D extent_ = {0, 0};
  std::array<VoyVulkanImage, kFramesInFlight> ring_;
  uint64_t frame_ = 0;  // of the target, from 1: what its timeline semaphores count
};

}  // namespace host
