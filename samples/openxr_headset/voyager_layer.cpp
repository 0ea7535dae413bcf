#include "voyager_layer.h"

#include <cstdio>

#include "failure.h"

namespace host {

VoyagerLayer::VoyagerLayer(const Graphics& graphics, const VoyagerOptions& options)
    : graphics_(graphics), frame_time_(options.frame_time) {
  create_device(options.memory_budget);
  open_scene(options);
  for (uint32_t i = 0; i < options.pairs; ++i)
    pairs_.emplace_back(graphics_, device_, scene_, options.tau);
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
  if (frame_time_ > 0 && !has_tree_)
    throw Failure(
        kBadUsage,
        "--time-budget: found a scene without a tree, which draws every leaf whatever tau "
        "is; expected one that was baked");
  streams_ = scene_.profile().streamed != 0;  // a flat file is loaded whole
}

void VoyagerLayer::hold_frame_time(double milliseconds) {
  frame_time_ = milliseconds;
  share_frame_time();
}

// Each pair has a part of the time: its part of the pixels. Of the outer pair that is 0.43 to 0.74
// where, drawn alone, it took 0.51 to 0.63 of the time (bench/NOTES.md, "Two pictures an eye").
// Where a GPU draws both at once, each is measured with some of the other's work in it, so that τ
// is coarser than it would have to be.
void VoyagerLayer::share_frame_time() {
  if (frame_time_ <= 0) return;
  for (size_t i = 0; i < pairs_.size(); ++i)
    pairs_[i].hold_frame_time(frame_time_ * pixel_shares_[i]);
}

std::string VoyagerLayer::summary() const {
  std::string summary;
  for (const EyePair& pair : pairs_) {
    const std::string of_pair = pair.summary();
    if (of_pair.empty()) return {};
    summary += (summary.empty() ? "" : ", inner ") + of_pair;
  }
  if (!streams_) return summary;
  VoyStreamingStats streaming = VOY_STREAMING_STATS_INIT;
  voy::check(voyGetStreamingStats(scene_.get(), &streaming));
  char text[256];
  std::snprintf(text, sizeof text, "; streamed: %llu of %llu chunks resident, %llu read, %.2f MB",
                static_cast<unsigned long long>(streaming.residentChunks),
                static_cast<unsigned long long>(scene_.info().chunkCount),
                static_cast<unsigned long long>(streaming.arrivedChunks),
                static_cast<double>(scene_.info().residentBytes) / 1e6);
  return summary + text;
}

void VoyagerLayer::resize(const std::vector<VkExtent2D>& extents, bool depth) {
  double all = 0;
  pixel_shares_.assign(pairs_.size(), 0);
  for (size_t i = 0; i < extents.size(); ++i) {
    const double pixels = static_cast<double>(extents[i].width) * extents[i].height;
    pixel_shares_[i / kEyes] += pixels;
    all += pixels;
  }
  for (double& share : pixel_shares_) share /= all;
  share_frame_time();
  for (size_t i = 0; i < pairs_.size(); ++i)
    pairs_[i].resize(std::span(extents).subspan(i * kEyes, kEyes), depth);
}

void VoyagerLayer::begin_frame() {
  for (EyePair& pair : pairs_) pair.begin_frame();
}

void VoyagerLayer::record_release(VkCommandBuffer commands, uint32_t slot) const {
  for (const EyePair& pair : pairs_) pair.record_release(commands, slot);
}

void VoyagerLayer::signal_released(Submission& submission, uint32_t slot) const {
  for (const EyePair& pair : pairs_) pair.signal_released(submission, slot);
}

void VoyagerLayer::render(const std::vector<Camera>& views, double near_z, uint32_t slot) {
  for (size_t i = 0; i < pairs_.size(); ++i)
    pairs_[i].render(std::span(views).subspan(i * kEyes, kEyes), near_z, slot);
}

void VoyagerLayer::record_acquire(VkCommandBuffer commands, uint32_t slot) const {
  for (const EyePair& pair : pairs_) pair.record_acquire(commands, slot);
}

void VoyagerLayer::wait_for_rendered(Submission& submission, uint32_t slot) const {
  for (const EyePair& pair : pairs_) pair.wait_for_rendered(submission, slot);
}

}  // namespace host
