#pragma once
// Voyager in this engine: the part to copy. It owns a device, a scene, a view, and a target
// whose ring has an image for each frame in flight. open_scene() streams, hold_frame_time() steers
// the level of detail; nothing else is needed for either. The order of a frame:
//   1. commands A: the host's meshes, record_depth_limit, record_release; their submission
//      signals released()
//   2. render()
//   3. commands B: record_acquire, then record_composite in a render pass; their submission
//      waits for rendered()
// At half the rate every second frame is record_composite alone, of the image before.
#include <optional>
#include <string>
#include <voyager/voyager.hpp>

#include "camera.h"
#include "device.h"
#include "submission.h"
#include "voyager_ring.h"

namespace host {

struct VoyagerOptions {
  std::string scene;
  double tau = 3;
  double frame_time = 0;               // as hold_frame_time(), or 0: tau is fixed
  uint64_t memory_budget = 0;          // bytes of scene data; 0: no limit, and no streaming
  std::optional<VoyPose> first_frame;  // where the first frames look from, if it is known
  VoyBackend backend = VOY_BACKEND_AUTO;
  VoyVulkanSharing sharing = VOY_VULKAN_SHARING_AUTO;
  VoyVulkanSync sync = VOY_VULKAN_SYNC_AUTO;
  uint32_t images = 2;  // frames in flight
};

// The host's depth buffer, in TRANSFER_SRC_OPTIMAL.
struct HostDepth {
  VkImage image;
  VkFormat format;
};

class VoyagerLayer {
 public:
  VoyagerLayer(const Device& device, const VoyagerOptions& options, const DepthConvention& depth);

  const VoyCapabilities& capabilities() const { return capabilities_; }
  const VoyVulkanCapabilities& vulkan_capabilities() const { return vulkan_; }
  VoySceneInfo scene() const { return scene_.info(); }
  bool has_tree() const { return has_tree_; }
  VoyFrameStats stats() const { return view_.stats(); }
  // None of a scene that is in memory as a whole.
  std::optional<VoyStreamingStats> streaming() const;

  // From the next frame on. One ends the other.
  void set_tau(double pixels);
  // Voyager chooses tau so that its part of a frame takes no longer. Throws voy::Error for a scene
  // without a tree.
  void hold_frame_time(double milliseconds);

  // The queue must be idle: the target's images are replaced.
  void resize(VkExtent2D extent);
  void create_composite(VkRenderPass render_pass, VkFormat colour, VkFormat depth);

  void record_depth_limit(VkCommandBuffer commands, uint32_t image, const HostDepth& depth);
  void record_release(VkCommandBuffer commands, uint32_t image);
  void begin_frame() { ring_.begin_frame(); }  // before the semaphores of this frame are asked for
  SemaphoreUse released(uint32_t image) const { return ring_.released(image); }
  // With VOY_VULKAN_SYNC_HOST the host has waited until commands A are done.
  void render(const Camera& camera, uint32_t image, bool limited);
  SemaphoreUse rendered(uint32_t image) const { return ring_.rendered(image); }
  void record_acquire(VkCommandBuffer commands, uint32_t image);
  // reprojected: the camera of a frame for which the image that was rendered last is shown again;
  // that image was acquired already. NULL: as it was rendered.
  void record_composite(VkCommandBuffer commands, uint32_t image, VoyVulkanDepthUse depth_use,
                        const Camera* reprojected);

  bool host_waits() const { return vulkan_.sync == VOY_VULKAN_SYNC_HOST; }

 private:
  void create_device(const VoyagerOptions& options);
  void open_scene(const VoyagerOptions& options);
  void create_view(VkExtent2D largest);

  const Device& vulkan_device_;
  const DepthConvention depth_;
  const uint32_t images_;
  voy::Device device_;
  VoyCapabilities capabilities_ = VOY_CAPABILITIES_INIT;
  VoyVulkanCapabilities vulkan_ = VOY_VULKAN_CAPABILITIES_INIT;
  voy::Scene scene_;
  bool has_tree_ = false, streams_ = false;
  voy::View view_;
  VkExtent2D view_extent_ = {0, 0};
  double tau_, frame_time_;
  Camera rendered_ = {};  // of the last frame
  voy::Handle<VoyVulkanComposite, voyDestroyVulkanComposite> composite_;
  VoyagerRing ring_;
};

}  // namespace host
