#pragma once
// Voyager in this headset: the part to copy. It owns a device, a scene, a view of two eyes, and
// a target whose ring has an image for each frame in flight, with a layer for each eye; or,
// where the eyes' images differ in size, a target an eye. open_scene() streams, hold_frame_time()
// steers the level of detail; nothing else is needed for either. The order of a frame:
//   1. commands A: record_release; their submission does signal_released
//   2. render()
//   3. commands B: record_acquire, then draws that sample the images; their submission does
//      wait_for_rendered
#include <array>
#include <optional>
#include <string>
#include <voyager/voyager.hpp>

#include "camera.h"
#include "frames_in_flight.h"
#include "graphics.h"
#include "submission.h"
#include "voyager_ring.h"

namespace host {

struct VoyagerOptions {
  std::string scene;
  double tau = 3;
  double frame_time = 0;               // as hold_frame_time(), or 0: tau is fixed
  uint64_t memory_budget = 0;          // bytes of scene data; 0: no limit, and no streaming
  std::optional<VoyPose> first_frame;  // where the first frames look from, if it is known
};

class VoyagerLayer {
 public:
  // Throws Failure where the library draws no stereo.
  VoyagerLayer(const Graphics& graphics, const VoyagerOptions& options);

  const VoyCapabilities& capabilities() const { return capabilities_; }
  const VoyVulkanCapabilities& vulkan_capabilities() const { return vulkan_; }
  const voy::Device& device() const { return device_; }
  const voy::Scene& scene() const { return scene_; }
  bool has_tree() const { return has_tree_; }
  // Voyager chooses tau from the next frame on so that its part of a frame, both eyes, takes no
  // longer. Throws voy::Error for a scene without a tree.
  void hold_frame_time(double milliseconds);
  // Of the last frame that is known of, and what is in memory, for people. Empty before the first.
  std::string summary() const;
  VkExtent2D largest() const { return {capabilities_.maxWidth, capabilities_.maxHeight}; }

  // The queue must be idle: the targets' images are replaced.
  void resize(const std::array<VkExtent2D, kEyes>& extents, bool depth);
  // What the draws of an eye sample: arrays, of which the eye has this layer.
  const VoyVulkanImage& image(uint32_t slot, size_t eye) const { return ring(eye).image(slot); }
  uint32_t layer(size_t eye) const { return rings_.size() == 1 ? static_cast<uint32_t>(eye) : 0; }

  void begin_frame();  // before the semaphores of this frame are asked for
  void record_release(VkCommandBuffer commands, uint32_t slot) const;
  void signal_released(Submission& submission, uint32_t slot) const;
  // With VOY_VULKAN_SYNC_HOST the host has waited until commands A are done.
  void render(const std::array<Camera, kEyes>& eyes, double near_z, uint32_t slot);
  void record_acquire(VkCommandBuffer commands, uint32_t slot) const;
  void wait_for_rendered(Submission& submission, uint32_t slot) const;

  bool host_waits() const { return vulkan_.sync == VOY_VULKAN_SYNC_HOST; }

 private:
  void create_device(uint64_t memory_budget);
  void open_scene(const VoyagerOptions& options);
  void create_view(VkExtent2D largest);
  const VoyagerRing& ring(size_t eye) const { return rings_[rings_.size() == 1 ? 0 : eye]; }

  const Graphics& graphics_;
  const double tau_;
  double frame_time_;
  voy::Device device_;
  VoyCapabilities capabilities_ = VOY_CAPABILITIES_INIT;
  VoyVulkanCapabilities vulkan_ = VOY_VULKAN_CAPABILITIES_INIT;
  voy::Scene scene_;
  bool has_tree_ = false, streams_ = false;
  voy::View view_;
  VkExtent2D view_extent_ = {0, 0};
  bool has_drawn_ = false;          // with this view
  std::vector<VoyagerRing> rings_;  // one, or one an eye
};

}  // namespace host
