#include "voyager_layer.h"

#include <algorithm>

#include "failure.h"

namespace host {
namespace {

// What the draws sample with.
constexpr VkImageLayout kLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
constexpr VkPipelineStageFlags kStages = VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT;

}  // namespace

VoyagerLayer::VoyagerLayer(const Graphics& graphics, const std::string& scene, double tau,
                           double time_budget)
    : graphics_(graphics), tau_(tau), time_budget_(time_budget) {
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
  VoyTimeBudget budget = VOY_TIME_BUDGET_INIT;
  budget.milliseconds = time_budget_;
  if (time_budget_ > 0) desc.next = &budget;
  view_ = {};  // its buffers go before the new one's come
  view_ = device_.create_view(desc);
  view_extent_ = largest;
}

void VoyagerLayer::resize(const std::array<VkExtent2D, kEyes>& extents, bool depth) {
  rings_.clear();
  const VkExtent2D largest = {
      std::max({extents[0].width, extents[1].width, view_extent_.width}),
      std::max({extents[0].height, extents[1].height, view_extent_.height})};
  // A view keeps its cut: another is made only where an image outgrows it.
  if (largest.width > view_extent_.width || largest.height > view_extent_.height)
    create_view(largest);
  if (extents[0].width == extents[1].width && extents[0].height == extents[1].height) {
    rings_.push_back(make_ring(extents[0], kEyes, depth));
  } else {
    for (const VkExtent2D extent : extents) rings_.push_back(make_ring(extent, 1, depth));
  }
  frame_ = 0;
}

VoyagerLayer::Ring VoyagerLayer::make_ring(VkExtent2D extent, uint32_t layers, bool depth) const {
  VoyVulkanTargetDesc vulkan = VOY_VULKAN_TARGET_DESC_INIT;
  vulkan.imageCount = kFramesInFlight;
  vulkan.layerCount = layers;
  vulkan.depth = depth;
  VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
  desc.next = &vulkan;
  desc.kind = VOY_TARGET_KIND_VULKAN;
  desc.width = extent.width;
  desc.height = extent.height;
  Ring ring = {device_.create_target(desc), {}};
  uint32_t count = 0;
  voy::check(voyGetVulkanImages(ring.target.get(), kFramesInFlight, ring.images.data(), &count));
  return ring;
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
  for (const Ring& ring : rings_) voy::check(voyRecordVulkanRelease(ring.target.get(), &released));
}

uint64_t VoyagerLayer::timeline_value() const {
  return vulkan_.sync == VOY_VULKAN_SYNC_TIMELINE ? frame_ : 0;
}

// The semaphores are NULL with VOY_VULKAN_SYNC_HOST.
void VoyagerLayer::signal_released(Submission& submission, uint32_t slot) const {
  for (const Ring& ring : rings_) submission.signal({ring.images[slot].released, timeline_value()});
}
void VoyagerLayer::wait_for_rendered(Submission& submission, uint32_t slot) const {
  for (const Ring& ring : rings_)
    submission.wait({ring.images[slot].rendered, timeline_value()},
                    VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
}

void VoyagerLayer::render(const std::array<Camera, kEyes>& cameras, double near_z, uint32_t slot) {
  VoyFrameEye eyes[kEyes] = {VOY_FRAME_EYE_INIT, VOY_FRAME_EYE_INIT};
  for (uint32_t i = 0; i < kEyes; ++i) {
    eyes[i].pose = cameras[i].pose;
    eyes[i].frustum = cameras[i].frustum;
    eyes[i].target = ring(i).target.get();
    eyes[i].layer = layer(i);
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
  for (const Ring& ring : rings_) voy::check(voyRecordVulkanAcquire(ring.target.get(), &acquired));
}

}  // namespace host
