#pragma once
// Voyager in this headset: the part to copy, with eye_pair.h. It owns a device, a scene, and a pair
// of eyes' views, or two with quad views, the outer before the inner; for each a target whose ring
// has an image for each frame in flight. open_scene() streams, hold_frame_time() steers the level
// of detail; nothing else is needed for either. The order of a frame:
//   1. commands A: record_release; their submission does signal_released
//   2. render()
//   3. commands B: record_acquire, then draws that sample the images; their submission does
//      wait_for_rendered
#include <optional>
#include <string>
#include <vector>
#include <voyager/voyager.hpp>

#include "camera.h"
#include "eye_pair.h"
#include "graphics.h"
#include "submission.h"

namespace host {

struct VoyagerOptions {
  std::string scene;
  double tau = 3;
  double frame_time = 0;               // as hold_frame_time(), or 0: tau is fixed
  uint64_t memory_budget = 0;          // bytes of scene data; 0: no limit, and no streaming
  std::optional<VoyPose> first_frame;  // where the first frames look from, if it is known
  uint32_t pairs = 1;                  // of views, left and right; 2 with quad views
};

// A view below is one of view_count(), left and right by turns.
class VoyagerLayer {
 public:
  // Throws Failure where the library draws no stereo.
  VoyagerLayer(const Graphics& graphics, const VoyagerOptions& options);
  VoyagerLayer(const VoyagerLayer&) = delete;
  VoyagerLayer& operator=(const VoyagerLayer&) = delete;

  const VoyCapabilities& capabilities() const { return capabilities_; }
  const VoyVulkanCapabilities& vulkan_capabilities() const { return vulkan_; }
  const voy::Device& device() const { return device_; }
  const voy::Scene& scene() const { return scene_; }
  bool has_tree() const { return has_tree_; }
  // Voyager chooses tau from the next frame on so that its part of a frame, all views, takes no
  // longer. Throws voy::Error for a scene without a tree.
  void hold_frame_time(double milliseconds);
  // Of the last frame that is known of, and what is in memory, for people. Empty before the first.
  std::string summary() const;
  VkExtent2D largest() const { return {capabilities_.maxWidth, capabilities_.maxHeight}; }
  size_t view_count() const { return pairs_.size() * kEyes; }

  // The queue must be idle: the targets' images are replaced. extents: of each view.
  void resize(const std::vector<VkExtent2D>& extents, bool depth);
  // What the draws of a view sample: arrays, of which the view has this layer.
  const VoyVulkanImage& image(uint32_t slot, size_t view) const {
    return pairs_[view / kEyes].image(slot, view % kEyes);
  }
  uint32_t layer(size_t view) const { return pairs_[view / kEyes].layer(view % kEyes); }

  void begin_frame();  // before the semaphores of this frame are asked for
  void record_release(VkCommandBuffer commands, uint32_t slot) const;
  void signal_released(Submission& submission, uint32_t slot) const;
  // With VOY_VULKAN_SYNC_HOST the host has waited until commands A are done.
  void render(const std::vector<Camera>& views, double near_z, uint32_t slot);
  void record_acquire(VkCommandBuffer commands, uint32_t slot) const;
  void wait_for_rendered(Submission& submission, uint32_t slot) const;

  bool host_waits() const { return vulkan_.sync == VOY_VULKAN_SYNC_HOST; }

 private:
  void create_device(uint64_t memory_budget);
  void open_scene(const VoyagerOptions& options);
  void share_frame_time();

  const Graphics& graphics_;
  double frame_time_;
  voy::Device device_;
  VoyCapabilities capabilities_ = VOY_CAPABILITIES_INIT;
  VoyVulkanCapabilities vulkan_ = VOY_VULKAN_CAPABILITIES_INIT;
  voy::Scene scene_;
  bool has_tree_ = false, streams_ = false;
  std::vector<EyePair> pairs_;
  std::vector<double> pixel_shares_;  // of each pair, of the pixels of all; from resize() on
};

}  // namespace host
