// A frame into a ring: what it waits for and signals, where it is drawn, and the end of those
// that are in flight.
#include <algorithm>
#include <chrono>
#include <string>
#include <thread>

#include "runtime/base/error.h"
#include "vulkan_interop/ring.h"

namespace voyager::vulkan {
namespace {

constexpr uint64_t kPatience = std::chrono::nanoseconds(kHostPatience).count();

}  // namespace

void Ring::check_values(const FrameSync& sync) const {
  const auto expect = [](bool holds, const char* field, uint64_t found, const std::string& what) {
    if (holds) return;
    throw Error(ErrorCode::invalid_argument, std::string("VoyVulkanFrame.") + field + ": found " +
                                                 std::to_string(found) + ", expected " + what);
  };
  switch (device_->sync()) {
    case Sync::timeline:
      expect(sync.signal_value > last_signal_, "signalValue", sync.signal_value,
             "more than the frame before, " + std::to_string(last_signal_));
      break;
    case Sync::binary:
      expect(sync.wait_value <= 1, "waitValue", sync.wait_value, "0 or 1 with BINARY");
      expect(sync.signal_value <= 1, "signalValue", sync.signal_value, "0 or 1 with BINARY");
      break;
    default:
      expect(sync.wait_value == 0, "waitValue", sync.wait_value, "0 with HOST");
      expect(sync.signal_value == 0, "signalValue", sync.signal_value, "0 with HOST");
      break;
  }
}

void Ring::check_released(uint32_t index, const char* field) const {
  const Holder holder = slots_[index].holder;
  if (holder == Holder::voyager) return;
  throw Error(ErrorCode::invalid_argument,
              std::string(field) + ": found image " + std::to_string(index) +
                  (holder == Holder::host ? ", which the host has acquired and not released since"
                                          : ", which the host has never released") +
                  ", expected voyRecordVulkanRelease of it first");
}

void Ring::wait_for_host(const FrameSync& sync) const {
  if (shared() || device_->sync() != Sync::timeline || sync.wait_value == 0) return;
  const VkSemaphore semaphore = slots_[0].image.released;
  const VkSemaphoreWaitInfo info{
      VK_STRUCTURE_TYPE_SEMAPHORE_WAIT_INFO, nullptr, 0, 1, &semaphore, &sync.wait_value};
  const VkResult status = device_->functions().WaitSemaphores(device_->handle(), &info, kPatience);
  check(status, "vkWaitSemaphores");
  if (status == VK_TIMEOUT)
    throw Error(ErrorCode::timeout, "VoyVulkanFrame.waitValue: `released` did not reach " +
                                        std::to_string(sync.wait_value) +
                                        " within 10 s, expected its signal to have been submitted");
}

Image Ring::begin_frame(uint32_t index, uint32_t layer, const FrameSync& sync) {
  check_values(sync);
  check_released(index, "VoyVulkanFrame.imageIndex");
  wait_for_host(sync);
  Image image;
  image.format = desc_.format;
  image.width = desc_.width;
  image.height = desc_.height;
  if (shared()) {
    ExternalTarget& external = image.external;
    external.ring = external_.get();
    external.slot = index;
    external.layer = layer;
    external.waits = sync.wait_value != 0;
    external.signals = sync.signal_value != 0;
    external.wait_value = sync.wait_value;
    external.signal_value = sync.signal_value;
    last_wait_ = std::max(last_wait_.load(), sync.wait_value);
    return image;
  }
  if (desc_.format != ColorFormat::none) {
    image.color = staging_->mapped() + staging_->color_at(index, layer);
    image.color_pitch = size_t{desc_.width} * pixel_bytes(desc_.format);
  }
  if (desc_.depth) {
    image.depth = reinterpret_cast<float*>(staging_->mapped() + staging_->depth_at(index, layer));
    image.depth_pitch = size_t{desc_.width} * sizeof(float);
  }
  return image;
}

void Ring::set_limits(uint32_t index, uint32_t layer, DepthLimits& limits) const {
  if (shared()) return;
  limits.values =
      reinterpret_cast<const float*>(staging_->mapped() + staging_->limit_at(index, layer));
  limits.pitch = size_t{desc_.width} * sizeof(float);
}

void Ring::end_frame(const FrameSync& sync) {
  // Without semaphores the host takes the image as soon as the call returns.
  if (shared() && device_->sync() == Sync::host) external_->wait();
  if (!shared() && device_->sync() == Sync::timeline) {
    const VkSemaphoreSignalInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO, nullptr,
                                     slots_[0].image.rendered, sync.signal_value};
    check(device_->functions().SignalSemaphore(device_->handle(), &info), "vkSignalSemaphore");
  }
  last_signal_ = sync.signal_value;
}

bool Ring::release_in_the_hosts_stead() const noexcept {
  const DeviceFunctions& vk = device_->functions();
  const VkSemaphore released = slots_[0].image.released;
  uint64_t reached = 0;
  if (vk.GetSemaphoreCounterValue(device_->handle(), released, &reached) != VK_SUCCESS)
    return false;
  const uint64_t wanted = last_wait_;
  if (reached >= wanted) return true;
  const VkSemaphoreSignalInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_SIGNAL_INFO, nullptr, released,
                                   wanted};
  return vk.SignalSemaphore(device_->handle(), &info) == VK_SUCCESS;
}

bool Ring::finish() noexcept {
  if (!external_) return true;
  const auto start = std::chrono::steady_clock::now();
  const auto patience = external_->patience_at_end();
  bool released = device_->sync() != Sync::timeline;
  while (!external_->idle()) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    const auto waited = std::chrono::steady_clock::now() - start;
    if (!released && waited >= patience) released = release_in_the_hosts_stead();
    if (waited >= 5 * patience) return false;
  }
  return true;
}

}  // namespace voyager::vulkan
