#include "voyager_layer.h"

#include <algorithm>

namespace host {
VoyagerLayer::VoyagerLayer(const Device& device, const VoyagerOptions& options,
                           const DepthConvention& depth)
    : vulkan_device_(device), depth_(depth), images_(options.images), tau_(options.tau) {
  create_device(options);
  scene_ = device_.open_scene(options.scene);
  scene_info_ = scene_.info();
}

void VoyagerLayer::create_device(const VoyagerOptions& options) {
  VoyVulkanDeviceDesc vulkan = vulkan_device_.voyager_desc();
  vulkan.sharing = options.sharing;
  vulkan.sync = options.sync;
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.next = &vulkan;
  desc.backend = options.backend;
  desc.memoryBudget = options.memory_budget;
  device_ = voy::Device::create(desc);
  capabilities_.next = &vulkan_;
  voy::check(voyGetCapabilities(device_.get(), &capabilities_));
  capabilities_.next = nullptr;
}

void VoyagerLayer::create_view(VkExtent2D largest) {
  const VoyScene scenes[] = {scene_.get()};
  VoyViewDesc desc = VOY_VIEW_DESC_INIT;
  desc.instanceCount = 1;
  desc.scenes = scenes;
  desc.maxWidth = largest.width;
  desc.maxHeight = largest.height;
  desc.tau = tau_;
  view_ = {};  // its buffers go before the new one's come
  view_ = device_.create_view(desc);
  view_extent_ = largest;
}

void VoyagerLayer::set_tau(double pixels) {
  tau_ = pixels;
  if (view_) view_.set_tau(pixels);
}

void VoyagerLayer::resize(VkExtent2D extent) {
  ring_ = {};
  // A view keeps its cut: another is made only where the image outgrows it.
  if (extent.width > view_extent_.width || extent.height > view_extent_.height)
    create_view(
        {std::max(extent.width, view_extent_.width), std::max(extent.height, view_extent_.height)});
  ring_ = VoyagerRing(vulkan_device_, device_, {extent, images_, VK_TRUE, VK_TRUE});
}

void VoyagerLayer::create_composite(VkRenderPass render_pass, VkFormat colour, VkFormat depth) {
  VoyVulkanCompositeDesc desc = VOY_VULKAN_COMPOSITE_DESC_INIT;
  desc.renderPass = render_pass;
  desc.colorFormat = colour;
  desc.depthFormat = depth;
  VoyComposite composite = nullptr;
  voy::check(voyCreateVulkanComposite(device_.get(), &desc, &composite));
  composite_ = decltype(composite_)(composite);
}

void VoyagerLayer::record_depth_limit(VkCommandBuffer commands, uint32_t image,
                                      const HostDepth& depth) {
  VoyVulkanDepthLimit limit = VOY_VULKAN_DEPTH_LIMIT_INIT;
  limit.commandBuffer = commands;
  limit.queueFamily = vulkan_device_.queue_family();
  limit.imageIndex = image;
  limit.depth = depth.image;
  limit.format = depth.format;
  voy::check(voyRecordVulkanDepthLimit(ring_.target(), &limit));
}

void VoyagerLayer::record_release(VkCommandBuffer commands, uint32_t image) {
  ring_.record_release(commands, image);
}

void VoyagerLayer::render(const Camera& camera, uint32_t image, bool limited) {
  VoyEyeDepthLimit limit = VOY_EYE_DEPTH_LIMIT_INIT;  // depth NULL: what was recorded
  limit.encoding = depth_.encoding;
  limit.nearZ = depth_.near_z;
  limit.farZ = depth_.far_z;
  VoyFrameEye eye = VOY_FRAME_EYE_INIT;
  if (limited) eye.next = &limit;
  eye.pose = camera.pose;
  eye.frustum = camera.frustum;
  eye.target = ring_.target();
  const VoyVulkanFrame vulkan = ring_.frame(image);
  VoyFrame frame = VOY_FRAME_INIT;
  frame.next = &vulkan;
  frame.eyeCount = 1;
  frame.eyes = &eye;
  frame.nearZ = depth_.near_z;
  view_.render(frame);
}

void VoyagerLayer::record_acquire(VkCommandBuffer commands, uint32_t image) {
  ring_.record_acquire(commands, image);
}

void VoyagerLayer::record_composite(VkCommandBuffer commands, uint32_t image,
                                    VoyVulkanDepthUse depth_use) {
  VoyVulkanCompositeDraw draw = VOY_VULKAN_COMPOSITE_DRAW_INIT;
  draw.commandBuffer = commands;
  draw.target = ring_.target();
  draw.imageIndex = image;
  draw.area = {{0, 0}, ring_.extent()};
  draw.depthUse = depth_use;
  draw.encoding = depth_.encoding;
  draw.nearZ = depth_.near_z;
  draw.farZ = depth_.far_z;
  voy::check(voyRecordVulkanComposite(composite_.get(), &draw));
}

}  // namespace host
