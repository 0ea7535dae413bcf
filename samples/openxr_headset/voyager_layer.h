#pragma once
// Voyager in this headset: the part to copy. It owns a device, a scene, a view of two eyes, and
// a target whose ring has an image for each frame in flight, with a layer for each eye; or,
// where the eyes' images differ in size, a target an eye. The order of a frame:
//   1. commands A: record_release; their submission does signal_released
//   2. render()
//   3. commands B: record_acquire, then draws that sample the images; their submission does
//      wait_for_rendered
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
  // time_budget: milliseconds a frame, or 0: tau stays. Throws Failure where the library draws
  // no stereo.
  VoyagerLayer(const Graphics& graphics, const std::string& scene, double tau, double time_budget);

  const VoyCapabilities& capabilities() const { return capabilities_; }
  const VoyVulkanCapabilities& vulkan_capabilities() const { return vulkan_; }
  const voy::Device& device() const { return device_; }
  const voy::Scene& scene() const { return scene_; }
  // That of the last frame that is known of.
  double tau() const { return frame_ == 0 ? tau_ : view_.stats().tau; }
  VkExtent2D largest() const { return {capabilities_.maxWidth, capabilities_.maxHeight}; }

  // The queue must be idle: the targets' images are replaced.
  void resize(const std::array<VkExtent2D, kEyes>& extents, bool depth);
  // What the draws of an eye sample: arrays, of which the eye has this layer.
  const VoyVulkanImage& image(uint32_t slot, size_t eye) const { return ring(eye).images[slot]; }
  uint32_t layer(size_t eye) const { return rings_.size() == 1 ? static_cast<uint32_t>(eye) : 0; }

  void begin_frame() { ++frame_; }  // before the semaphores of this frame are asked for
  void record_release(VkCommandBuffer commands, uint32_t slot) const;
  void signal_released(Submission& submission, uint32_t slot) const;
  // With VOY_VULKAN_SYNC_HOST the host has waited until commands A are done.
  void render(const std::array<Camera, kEyes>& eyes, double near_z, uint32_t slot);
  void record_acquire(VkCommandBuffer commands, uint32_t slot) const;
  void wait_for_rendered(Submission& submission, uint32_t slot) const;

  bool host_waits() const { return vulkan_.sync == VOY_VULKAN_SYNC_HOST; }

 private:
  struct Ring {
    voy::Target target;
    std::array<VoyVulkanImage, kFramesInFlight> images;
  };

  void create_device();
  void create_view(VkExtent2D largest);
  Ring make_ring(VkExtent2D extent, uint32_t layers, bool depth) const;
  const Ring& ring(size_t eye) const { return rings_[rings_.size() == 1 ? 0 : eye]; }
  VoyVulkanUse use(VkCommandBuffer commands, uint32_t slot) const;
  uint64_t timeline_value() const;

  const Graphics& graphics_;
  const double tau_, time_budget_;
  voy::Device device_;
  VoyCapabilities capabilities_ = VOY_CAPABILITIES_INIT;
  VoyVulkanCapabilities vulkan_ = VOY_VULKAN_CAPABILITIES_INIT;
  voy::Scene scene_;
  voy::View view_;
  VkExtent2D view_extent_ = {0, 0};
  std::vector<Ring> rings_;  // one, or one an eye
  uint64_t frame_ = 0;       // of the rings, from 1: what their timeline semaphores count
};

}  // namespace host
