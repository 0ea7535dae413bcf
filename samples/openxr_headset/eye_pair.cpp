#include "eye_pair.h"

#include <algorithm>
#include <cstdio>

namespace host {
namespace {

VoyTimeBudget time_budget(double milliseconds) {
  VoyTimeBudget budget = VOY_TIME_BUDGET_INIT;
  budget.milliseconds = milliseconds;
  return budget;
}

}  // namespace

EyePair::EyePair(const Graphics& graphics, const voy::Device& device, const voy::Scene& scene,
                 double tau)
    : graphics_(&graphics), device_(&device), scene_(&scene), tau_(tau) {}

void EyePair::hold_frame_time(double milliseconds) {
  if (milliseconds == frame_time_) return;  // its controller goes on
  frame_time_ = milliseconds;
  if (view_) view_.set_time_budget(time_budget(milliseconds));
}

std::string EyePair::summary() const {
  if (!has_drawn_) return {};
  const VoyFrameStats frame = view_.stats();
  char text[128];
  std::snprintf(text, sizeof text, "tau %g", frame.tau);
  std::string summary = text;
  if (frame.millisecondsBudget > 0) {
    std::snprintf(text, sizeof text, " to take %g ms", frame.millisecondsBudget);
    summary += text;
  }
  return summary;
}

void EyePair::create_view(VkExtent2D largest) {
  const VoyScene scenes[] = {scene_->get()};
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
  view_ = device_->create_view(desc);
  view_extent_ = largest;
  has_drawn_ = false;
}

void EyePair::resize(std::span<const VkExtent2D> extents, bool depth) {
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
    rings_.emplace_back(*graphics_, *device_,
                        RingDesc{extents[i], kFramesInFlight, depth, VK_FALSE, layers});
}

void EyePair::begin_frame() {
  for (VoyagerRing& ring : rings_) ring.begin_frame();
}

void EyePair::record_release(VkCommandBuffer commands, uint32_t slot) const {
  for (const VoyagerRing& ring : rings_) ring.record_release(commands, slot);
}

// The semaphores are NULL with VOY_VULKAN_SYNC_HOST.
void EyePair::signal_released(Submission& submission, uint32_t slot) const {
  for (const VoyagerRing& ring : rings_) submission.signal(ring.released(slot));
}
void EyePair::wait_for_rendered(Submission& submission, uint32_t slot) const {
  for (const VoyagerRing& ring : rings_)
    submission.wait(ring.rendered(slot), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
}

void EyePair::render(std::span<const Camera> cameras, double near_z, uint32_t slot) {
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

void EyePair::record_acquire(VkCommandBuffer commands, uint32_t slot) const {
  for (const VoyagerRing& ring : rings_) ring.record_acquire(commands, slot);
}

}  // namespace host
