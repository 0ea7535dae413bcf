#include "voyager_layer.h"

#include <algorithm>
#include <cstdio>

#include "failure.h"

namespace host {
namespace {

VoyTimeBudget time_budget(double milliseconds) {
  VoyTimeBudget budget = VOY_TIME_BUDGET_INIT;
  budget.milliseconds = milliseconds;
  return budget;
}

}  // namespace

VoyagerLayer::VoyagerLayer(const Graphics& graphics, const VoyagerOptions& options)
    : graphics_(graphics), tau_(options.tau), frame_time_(options.frame_time) {
  create_device(options.memory_budget);
  open_scene(options);
}

void VoyagerLayer::create_device(uint64_t memory_budget) {
  VoyVulkanDeviceDesc vulkan = graphics_.voyager_desc();
  VoyDeviceDesc desc = VOY_DEVICE_DESC_INIT;
  desc.next = &vulkan;
  desc.hostMemoryBudget = desc.deviceMemoryBudget = memory_budget;  // whichever draws
  device_ = voy::Device::create(desc);
  capabilities_.next = &vulkan_;
  voy::check(voyGetCapabilities(device_.get(), &capabilities_));
  capabilities_.next = nullptr;
  if (capabilities_.maxEyes < kEyes)
    throw Failure(kBadUsage, "the Voyager library: found views of " +
                                 std::to_string(capabilities_.maxEyes) + " eye, expected of 2");
}

// Within a budget a scene is streamed: what frames need is read while they are drawn, none of them
// waits for it, and the budget is never exceeded. Voyager itself reads ahead of where the head
// moves.
void VoyagerLayer::open_scene(const VoyagerOptions& options) {
  VoySceneStreaming streaming = VOY_SCENE_STREAMING_INIT;
  if (options.first_frame) streaming.startPosition = options.first_frame->position;
  VoySceneDesc desc = VOY_SCENE_DESC_INIT;
  desc.path = options.scene.c_str();
  if (options.memory_budget > 0) desc.next = &streaming;
  scene_ = device_.open_scene(desc);
  has_tree_ = scene_.info().nodeCount > 0;
  streams_ = scene_.profile().streamed != 0;  // a flat file is loaded whole
}

void VoyagerLayer::hold_frame_time(double milliseconds) {
  frame_time_ = milliseconds;
  if (view_) view_.set_time_budget(time_budget(milliseconds));
}

std::string VoyagerLayer::summary() const {
  if (!has_drawn_) return {};
  const VoyFrameStats frame = view_.stats();
  char text[256];
  std::snprintf(text, sizeof text, "tau %g", frame.tau);
  std::string summary = text;
  if (frame.millisecondsBudget > 0) {
    std::snprintf(text, sizeof text, " to take %g ms", frame.millisecondsBudget);
    summary += text;
  }
  if (!streams_) return summary;
  VoyStreamingStats streaming = VOY_STREAMING_STATS_INIT;
  voy::check(voyGetStreamingStats(scene_.get(), &streaming));
  std::snprintf(text, sizeof text, "; streamed: %llu of %llu chunks resident, %llu read, %.2f MB",
                static_cast<unsigned long long>(streaming.residentChunks),
                static_cast<unsigned long long>(scene_.info().chunkCount),
                static_cast<unsigned long long>(streaming.arrivedChunks),
                static_cast<double>(scene_.info().residentBytes) / 1e6);
  return summary + text;
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
  const VoyTimeBudget budget = time_budget(frame_time_);
  if (frame_time_ > 0) desc.next = &budget;
  view_ = {};  // its buffers go before the new one's come
  view_ = device_.create_view(desc);
  view_extent_ = largest;
  has_drawn_ = false;
}

void VoyagerLayer::resize(const std::array<VkExtent2D, kEyes>& extents, bool depth) {
  rings_.clear();
  const VkExtent2D largest = {
      std::max({extents[0].width, extents[1].width, view_extent_.width}),
      std::max({extents[0].height, extents[1].height, view_extent_.height})};
  // A view keeps its cut: another is made only where an image outgrows it.
  if (largest.width > view_extent_.width || largest.height > view_extent_.height)
    create_view(largest);
  const bool alike = extents[0].width == extents[1].width && extents[0].height == extents[1].height;
  const uint32_t layers = alike ? kEyes : 1;
  for (size_t i = 0; i < kEyes / layers; ++i)
    rings_.emplace_back(graphics_, device_,
                        RingDesc{extents[i], kFramesInFlight, depth, VK_FALSE, layers});
}

void VoyagerLayer::begin_frame() {
  for (VoyagerRing& ring : rings_) ring.begin_frame();
}

void VoyagerLayer::record_release(VkCommandBuffer commands, uint32_t slot) const {
  for (const VoyagerRing& ring : rings_) ring.record_release(commands, slot);
}

// The semaphores are NULL with VOY_VULKAN_SYNC_HOST.
void VoyagerLayer::signal_released(Submission& submission, uint32_t slot) const {
  for (const VoyagerRing& ring : rings_) submission.signal(ring.released(slot));
}
void VoyagerLayer::wait_for_rendered(Submission& submission, uint32_t slot) const {
  for (const VoyagerRing& ring : rings_)
    submission.wait(ring.rendered(slot), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
}

void VoyagerLayer::render(const std::array<Camera, kEyes>& cameras, double near_z, uint32_t slot) {
  VoyFrameEye eyes[kEyes] = {VOY_FRAME_EYE_INIT, VOY_FRAME_EYE_INIT};
  for (uint32_t i = 0; i < kEyes; ++i) {
    eyes[i].pose = cameras[i].pose;
    eyes[i].frustum = cameras[i].frustum;
    eyes[i].target = ring(i).target();
    eyes[i].layer = layer(i);
  }
  const VoyVulkanFrame vulkan = rings_[0].frame(slot);  // the rings are in step
  VoyFrame frame = VOY_FRAME_INIT;
  frame.next = &vulkan;
  frame.eyeCount = kEyes;
  frame.eyes = eyes;
  frame.nearZ = near_z;
  view_.render(frame);
  has_drawn_ = true;
}

void VoyagerLayer::record_acquire(VkCommandBuffer commands, uint32_t slot) const {
  for (const VoyagerRing& ring : rings_) ring.record_acquire(commands, slot);
}

}  // namespace host
