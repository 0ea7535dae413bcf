#pragma once
// A render pass over Unity's textures in which Voyager composites its image.
#include <voyager/voyager_vulkan.h>

#include <memory>
#include <voyager/voyager.hpp>

#include "device_functions.h"
#include "unity_interfaces.h"

namespace voyager_unity {

// Views and a framebuffer of textures, for one frame: Unity may replace the images at any time.
class Attachments {
 public:
  // `depth` may be NULL. Throws std::runtime_error. `functions` must outlive it.
  Attachments(const DeviceFunctions& functions, VkRenderPass pass, const UnityVulkanImage& colour,
              const UnityVulkanImage* depth);
  // The GPU must have finished the frame.
  ~Attachments();
  Attachments(const Attachments&) = delete;
  Attachments& operator=(const Attachments&) = delete;

  VkFramebuffer framebuffer() const { return framebuffer_; }

 private:
  VkImageView view_of(const UnityVulkanImage& image);
  void destroy();

  const DeviceFunctions& functions_;
  VkImageView views_[2] = {};
  VkFramebuffer framebuffer_ = VK_NULL_HANDLE;
};

// For textures of two formats. It keeps what the textures hold.
class CompositePass {
 public:
  // `depth` is UNDEFINED without a depth texture. Throws voy::Error and std::runtime_error.
  CompositePass(const DeviceFunctions& functions, const voy::Device& device, VkFormat colour,
                VkFormat depth);
  // The GPU must have finished all frames that used it.
  ~CompositePass();
  CompositePass(const CompositePass&) = delete;
  CompositePass& operator=(const CompositePass&) = delete;

  bool fits(VkFormat colour, VkFormat depth) const { return colour == colour_ && depth == depth_; }
  // Records the pass. The textures are in COLOR_ATTACHMENT_OPTIMAL and
  // DEPTH_STENCIL_ATTACHMENT_OPTIMAL, and stay there. `draw` lacks only the command buffer.
  // The result lives until the GPU has finished the frame.
  std::shared_ptr<Attachments> record(VkCommandBuffer commands, const UnityVulkanImage& colour,
                                      const UnityVulkanImage* depth,
                                      VoyVulkanCompositeDraw draw) const;

 private:
  void create_render_pass();

  const DeviceFunctions& functions_;
  VkFormat colour_, depth_;
  VkRenderPass pass_ = VK_NULL_HANDLE;
  voy::Handle<VoyVulkanComposite, voyDestroyVulkanComposite> composite_;
};

}  // namespace voyager_unity
