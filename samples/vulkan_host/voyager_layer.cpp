#include "voyager_layer.h"

#include <algorithm>

#include "failure.h"

namespace host {
VoyagerLayer::VoyagerLayer(const Device& device, const VoyagerOptions& options,
                           const DepthConvention& depth)
    : vulkan_device_(device),
      depth_(depth),
      images_(options.images),
      tau_(options.tau),
      frame_time_(options.frame_time) {
  create_device(options);
  open_scene(options);
}

void VoyagerLayer::create_device(const VoyagerOptions& options) {
  VoyVulkanDeviceDesc vulkan = vulkan_device_.voyager_desc();
  vulkan.sharing = options.sharing;
  vulkan.sync = options.sync;
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.next = &vulkan;
  desc.backend = options.backend;
  desc.hostMemoryBudget = desc.deviceMemoryBudget = options.memory_budget;  // whichever draws
  device_ = voy::Device::create(desc);
  capabilities_.next = &vulkan_;
  voy::check(voyGetCapabilities(device_.get(), &capabilities_));
  capabilities_.next = nullptr;
}

// Within a budget a scene is streamed: what frames need is read while they are drawn, none of them
// waits for it, and the budget is never exceeded.
void VoyagerLayer::open_scene(const VoyagerOptions& options) {
  VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
  if (options.first_frame) streaming.startPosition = options.first_frame->position;
  VoySceneDesc desc = VOY_SCENE_DESC_INIT;
  desc.path = options.scene.c_str();
  if (options.memory_budget > 0) desc.next = &streaming;
  scene_ = device_.open_scene(desc);
  has_tree_ = scene_.info().nodeCount > 0;
  if (frame_time_ > 0 && !has_tree_)
    throw Failure(
        kBadUsage,
        "--time-budget: found a scene without a tree, which draws every leaf whatever tau "
        "is; expected one that was baked");
  streams_ = scene_.profile().streamed != 0;  // a flat file is loaded whole
}

void VoyagerLayer::create_view(VkExtent2D largest) {
  const VoyScene scenes[] = {scene_.get()};
  VoyViewDesc desc = VOY_VIEW_DESC_INIT;
  desc.instanceCount = 1;
  desc.scenes = scenes;
  desc.maxWidth = largest.width;
  desc.maxHeight = largest.height;
  desc.tau = tau_;
  VoyTimeBudget budget = VOY_TIME_BUDGET_INIT;
  budget.milliseconds = frame_time_;
  if (frame_time_ > 0) desc.next = &budget;
  view_ = {};  // its buffers go before the new one's come
  view_ = device_.create_view(desc);
  view_extent_ = largest;
}

void VoyagerLayer::set_tau(double pixels) {
  tau_ = pixels;
  frame_time_ = 0;
  if (view_) view_.set_tau(pixels);
}

void VoyagerLayer::hold_frame_time(double milliseconds) {
  frame_time_ = milliseconds;
  VoyTimeBudget budget = VOY_TIME_BUDGET_INIT;
  budget.milliseconds = milliseconds;
  if (view_) view_.set_time_budget(budget);
}

std::optional<VoyStreamingStats> VoyagerLayer::streaming() const {
  if (!streams_) return std::nullopt;
  VoyStreamingStats stats = VOY_STREAMING_STATS_INIT;
  voy::check(voyGetStreamingStats(scene_.get(), &stats));
  return stats;
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
  VoyVulkanComposite composite = nullptr;
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
  limit.depthFormat = depth.format;
  voy::check(voyRecordVulkanDepthLimit(ring_.target(), &limit));
}

void VoyagerLayer::record_release(VkCommandBuffer commands, uint32_t image) {
  ring_.record_release(commands, image);
}

void VoyagerLayer::render(const Camera& camera, uint32_t image, bool limited) {
  VoyEyeDepthLimit limit = VOY_EYE_DEPTH_LIMIT_INIT;  // depth NULL: what was recorded
  limit.depthEncoding = depth_.encoding;
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
  rendered_ = camera;
}

void VoyagerLayer::record_acquire(VkCommandBuffer commands, uint32_t image) {
  ring_.record_acquire(commands, image);
}

void VoyagerLayer::record_composite(VkCommandBuffer commands, uint32_t image,
                                    VoyVulkanDepthUse depth_use, const Camera* reprojected) {
  VoyVulkanCompositeDraw draw = VOY_VULKAN_COMPOSITE_DRAW_INIT;
  draw.commandBuffer = commands;
  draw.target = ring_.target();
  draw.imageIndex = image;
  draw.area = {{0, 0}, ring_.extent()};
  draw.depthUse = depth_use;
  draw.depthEncoding = depth_.encoding;
  draw.nearZ = depth_.near_z;
  draw.farZ = depth_.far_z;
  VoyVulkanReprojection reprojection = VOY_VULKAN_REPROJECTION_INIT;
  if (reprojected) {
    reprojection.drawnPose = rendered_.pose;
    reprojection.drawnFrustum = rendered_.frustum;
    reprojection.pose = reprojected->pose;
    reprojection.frustum = reprojected->frustum;
    draw.next = &reprojection;
  }
  voy::check(voyRecordVulkanComposite(composite_.get(), &draw));
}

}  // namespace host
