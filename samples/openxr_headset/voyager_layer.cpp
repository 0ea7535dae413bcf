#include "voyager_layer.h"

#include <algorithm>

#include "failure.h"

namespace host {
namespace {

// What the draws sample with.
constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
constexpr VkPipelineStageFlags kStages = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;

}  // namespace

VoyagerLayer::VoyagerLayer(const Graphics& graphics, const std::string& scene, double tau)
    : graphics_(graphics), tau_(tau) {
  create_device();
  scene_ = device_.open_scene(scene);
}

void VoyagerLayer::create_device() {
  VoyVulkanDeviceDesc vulkan = graphics_.voyager_desc();
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.next = &vulkan;
  device_ = voy::Device::create(desc);
  capabilities_.next = &vulkan_;
  voy::check(voyGetCapabilities(device_.get(), &capabilities_));
  capabilities_.next = nullptr;
  if (capabilities_.maxEyes < kEyes)
    throw Failure(kBadUsage, "the Voyager library: found views of " +
                                 std::to_string(capabilities_.maxEyes) + " eye, expected of 2");
}

void VoyagerLayer::create_view(VkExtent2D largest) {
  const VoyScene scenes[] = {scene_.get()};
  VoyViewDesc desc = VOY_VIEW_DESC_INIT;
  desc.instanceCount = 1;
  desc.scenes = scenes;
  desc.eyeCount = kEyes;
  desc.maxWidth = largest.width;
  desc.maxHeight = largest.height;
  desc.tau = tau_;
  view_ = {};  // its buffers go before the new one's come
  view_ = device_.create_view(desc);
  view_extent_ = largest;
}

void VoyagerLayer::resize(VkExtent2D extent, bool depth) {
  target_ = {};
  // A view keeps its cut: another is made only where the image outgrows it.
  if (extent.width > view_extent_.width || extent.height > view_extent_.height)
    create_view(
        {std::max(extent.width, view_extent_.width), std::max(extent.height, view_extent_.height)});
  VoyVulkanTargetDesc vulkan = VOY_VULKAN_TARGET_DESC_INIT;
  vulkan.imageCount = kFramesInFlight;
  vulkan.layerCount = kEyes;
  vulkan.depth = depth;
  VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
  desc.next = &vulkan;
  desc.kind = VOY_TARGET_KIND_VULKAN;
  desc.width = extent.width;
  desc.height = extent.height;
  target_ = device_.create_target(desc);
  extent_ = extent;
  uint32_t count = 0;
  voy::check(voyGetVulkanImages(target_.get(), kFramesInFlight, ring_.data(), &count));
  frame_ = 0;
}

VoyVulkanUse VoyagerLayer::use(VkCommandBuffer commands, uint32_t slot) const {
  VoyVulkanUse use = VOY_VULKAN_USE_INIT;
  use.commandBuffer = commands;
  use.queueFamily = graphics_.queue_family();
  use.imageIndex = slot;
  use.layout = kLayout;
  use.stages = kStages;
  return use;
}

void VoyagerLayer::record_release(VkCommandBuffer commands, uint32_t slot) const {
  const VoyVulkanUse released = use(commands, slot);
  voy::check(voyRecordVulkanRelease(target_.get(), &released));
}

uint64_t VoyagerLayer::timeline_value() const {
  return vulkan_.sync == VOY_VULKAN_SYNC_TIMELINE ? frame_ : 0;
}

// Both are NULL with VOY_VULKAN_SYNC_HOST.
SemaphoreUse VoyagerLayer::released(uint32_t slot) const {
  return {ring_[slot].released, timeline_value()};
}
SemaphoreUse VoyagerLayer::rendered(uint32_t slot) const {
  return {ring_[slot].rendered, timeline_value()};
}

// Of the whole target, so that the eye's pixels are where they would be without the rest.
VoyFrustum VoyagerLayer::widened(const Camera& eye) const {
  VoyFrustum f = eye.frustum;
  if (eye.width < extent_.width) f.right = f.left + (f.right - f.left) * extent_.width / eye.width;
  if (eye.height < extent_.height) f.down = f.up - (f.up - f.down) * extent_.height / eye.height;
  return f;
}

void VoyagerLayer::render(const std::array<Camera, kEyes>& cameras, double near_z, uint32_t slot) {
  VoyFrameEye eyes[kEyes] = {VOY_FRAME_EYE_INIT, VOY_FRAME_EYE_INIT};
  for (uint32_t i = 0; i < kEyes; ++i) {
    eyes[i].pose = cameras[i].pose;
    eyes[i].frustum = widened(cameras[i]);
    eyes[i].target = target_.get();
    eyes[i].layer = i;
  }
  VoyVulkanFrame vulkan = VOY_VULKAN_FRAME_INIT;
  vulkan.imageIndex = slot;
  vulkan.waitValue = vulkan.signalValue =
      vulkan_.sync == VOY_VULKAN_SYNC_BINARY ? 1 : timeline_value();
  VoyFrame frame = VOY_FRAME_INIT;
  frame.next = &vulkan;
  frame.eyeCount = kEyes;
  frame.eyes = eyes;
  frame.nearZ = near_z;
  view_.render(frame);
}

void VoyagerLayer::record_acquire(VkCommandBuffer commands, uint32_t slot) const {
  const VoyVulkanUse acquired = use(commands, slot);
  voy::check(voyRecordVulkanAcquire(target_.get(), &acquired));
}

}  // namespace host
