#pragma once
// Voyager on Unity's device: from the device event that initialises graphics to the one that shuts
// them down.
#include <voyager/voyager_vulkan.h>

#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>
#include <voyager/voyager.hpp>

#include "composite_pass.h"
#include "device_functions.h"
#include "splat_images.h"
#include "unity_interfaces.h"

namespace voyager_unity {

// What a camera of Unity's draws. The textures are what Texture.GetNativeTexturePtr returns.
struct CameraFrame {
  VoyPose pose;
  VoyFrustum frustum;
  float near_z, far_z;  // metres
  void* colour;
  void* depth;  // or NULL: the splats are drawn over everything
};

class SplatRenderer {
 public:
  // Throws voy::Error, among others for a device without timeline semaphores.
  SplatRenderer(IUnityGraphicsVulkan& unity, const VoyVulkanDeviceDesc& device);
  // On the rendering thread, while the device exists. Waits until the GPU is idle.
  ~SplatRenderer();
  SplatRenderer(const SplatRenderer&) = delete;
  SplatRenderer& operator=(const SplatRenderer&) = delete;

  // On any thread. Blocks until the scene is open and replaces the one before it.
  void open_scene(const char* path);
  void close_scene();
  // Throws voy::Error without a frame.
  VoyFrameStats stats();

  // On the rendering thread, in an event outside of a render pass. A texture of a new size gets
  // its first splats in the event after. Throws voy::Error and std::runtime_error.
  void draw(const CameraFrame& frame);

 private:
  UnityVulkanImage observe(void* texture, const char* name) const;
  UnityVulkanImage attach(void* texture, VkImageLayout layout, VkPipelineStageFlags stages,
                          VkAccessFlags access) const;
  UnityVulkanRecordingState recording() const;
  void retire(std::shared_ptr<void> object, uint64_t frame);
  bool fit_images(VkExtent2D extent);
  void fit_pass(VkFormat colour, VkFormat depth);
  void fit_view(VkExtent2D extent);
  bool render(const CameraFrame& frame);
  void submit_signals();
  void composite(const CameraFrame& frame);

  IUnityGraphicsVulkan& unity_;
  const UnityVulkanInstance vulkan_;
  const DeviceFunctions functions_;
  voy::Device device_;
  std::mutex mutex_;  // what follows
  voy::Scene scene_;
  voy::View view_;
  VkExtent2D view_extent_ = {0, 0};
  std::shared_ptr<SplatImages> images_;
  std::shared_ptr<CompositePass> pass_;
  // What the GPU may still use, with the last frame that did.
  std::vector<std::pair<uint64_t, std::shared_ptr<void>>> retired_;
};

}  // namespace voyager_unity
