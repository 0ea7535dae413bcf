#include "tools/view/splat_view.h"

#include <algorithm>

#include "frames_in_flight.h"

namespace voyager::view {
namespace {

constexpr double kNear = 0.2;  // metres, as `voyager render` has it

VoyTimeBudget time_budget(const SplatSettings& settings) {
  VoyTimeBudget budget = VOY_TIME_BUDGET_INIT;
  budget.milliseconds = double{settings.milliseconds};
  budget.minTau = double{settings.least_tau};
  budget.maxTau = std::max(budget.maxTau, budget.minTau);
  return budget;
}

}  // namespace

void SplatView::create_view() {
  const VoyScene scene = scene_.get();
  VoyViewDesc desc = VOY_VIEW_DESC_INIT;
  desc.instanceCount = 1;
  desc.scenes = &scene;
  desc.maxWidth = view_extent_.width;
  desc.maxHeight = view_extent_.height;
  desc.tau = double{settings_.tau};
  desc.antialias = settings_.antialias;
  const VoyTimeBudget budget = time_budget(settings_);
  if (has_tree_ && settings_.milliseconds > 0) desc.next = &budget;
  view_ = {};  // its buffers go before the new one's come
  view_ = device_.create_view(desc);
  has_drawn_ = false;
}

void SplatView::resize(VkExtent2D extent) {
  ring_ = {};
  // A view keeps its cut: another is made only where the image outgrows it.
  if (extent.width > view_extent_.width || extent.height > view_extent_.height) {
    view_extent_ = {std::max(extent.width, view_extent_.width),
                    std::max(extent.height, view_extent_.height)};
    create_view();
  }
  ring_ = host::VoyagerRing(vulkan_, device_, {extent, host::kFramesInFlight});
}

void SplatView::set(const SplatSettings& settings) {
  if (settings == settings_) return;
  const bool other_view = settings.antialias != settings_.antialias;
  const bool budget_begins = settings_.milliseconds <= 0 && settings.milliseconds > 0;
  settings_ = settings;
  if (!view_) return;
  if (other_view) return create_view();
  // Where it was when it last held its time, so that the first frame is not late.
  if (budget_begins && held_tau_ > 0) view_.set_tau(held_tau_);
  if (!has_tree_ || settings.milliseconds <= 0)
    view_.set_tau(double{settings.tau});
  else
    view_.set_time_budget(time_budget(settings));
}

void SplatView::release(VkCommandBuffer commands) {
  image_ = (image_ + 1) % host::kFramesInFlight;
  ring_.begin_frame();
  ring_.record_release(commands, image_);
}

void SplatView::render(const host::Camera& camera, const float* background, bool wait) {
  VoyFrameEye eye = VOY_FRAME_EYE_INIT;
  eye.pose = camera.pose;
  eye.frustum = camera.frustum;
  eye.target = ring_.target();
  VoyFrameStreaming streaming = VOY_FRAME_STREAMING_INIT;
  streaming.waitResident = wait && has_tree_ ? 1 : 0;
  streaming.allowFallback = streaming.waitResident;
  VoyVulkanFrame vulkan = ring_.frame(image_);
  vulkan.next = &streaming;
  VoyFrame frame = VOY_FRAME_INIT;
  frame.next = &vulkan;
  frame.eyeCount = 1;
  frame.eyes = &eye;
  frame.nearZ = kNear;
  std::copy_n(background, 3, frame.background);
  view_.render(frame);
  has_drawn_ = true;
  if (has_tree_ && settings_.milliseconds > 0) held_tau_ = view_.stats().tau;
}

}  // namespace voyager::view
