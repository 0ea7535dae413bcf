#include "vulkan_interop/ring.h"

#include <fcntl.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>

#include "runtime/base/error.h"
#include "vulkan_interop/formats.h"

namespace voyager::vulkan {
namespace {

constexpr uint64_t kNanoseconds = 1'000'000'000;
constexpr uint64_t kPatience = 10 * kNanoseconds;  // with a signal that the host promised

// The host keeps its own, whatever happens to this one.
FileDescriptor copy_descriptor(int fd, const char* field) {
  const int copy = ::fcntl(fd, F_DUPFD_CLOEXEC, 0);
  if (copy >= 0) return FileDescriptor(copy);
  const std::string where = std::string(field) + ".fd: ";
  if (errno == EBADF)
    throw Error(ErrorCode::invalid_argument,
                where + "found " + std::to_string(fd) + ", expected an open file descriptor");
  throw Error(ErrorCode::io, where + "cannot be copied: " + std::strerror(errno));
}

ExternalMemory external_memory(const ImportedMemory& memory, const char* field) {
  return {copy_descriptor(memory.fd, field), memory.size, memory.offset, memory.dedicated};
}

bool is_attachment(VkImageUsageFlags usage) {
  return (usage & VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT) != 0;
}

void check_usage(VkImageUsageFlags usage, const char* field) {
  if ((usage & VK_IMAGE_USAGE_TRANSFER_DST_BIT) == 0)
    throw Error(ErrorCode::invalid_argument,
                std::string(field) + ": found " + std::to_string(usage) +
                    ", expected VK_IMAGE_USAGE_TRANSFER_DST_BIT among it for HOST sharing");
}

}  // namespace

Ring::Ring(std::shared_ptr<const Device> device, const RingDesc& desc, const ImportRing& import,
           std::pmr::memory_resource* memory)
    : device_(std::move(device)),
      desc_(desc),
      slots_(desc.images),
      descriptors_(*device_, desc.images) {
  check_imported();
  make_semaphores();
  for (uint32_t i = 0; i < desc.images; ++i) make_slot(i);
  if (shared())
    share(import);
  else
    staging_.emplace(*device_, desc_, memory);
}

Ring::~Ring() {
  // What a frame may still write to is better left than freed.
  if (!finish()) static_cast<void>(external_.release());
}

void Ring::check_imported() const {
  if (shared()) return;
  for (const ImportedImage& image : desc_.imported) {
    if (image.color != VK_NULL_HANDLE) check_usage(image.color_usage, "colorUsage");
    if (image.depth != VK_NULL_HANDLE) check_usage(image.depth_usage, "depthUsage");
  }
}

void Ring::make_semaphores() {
  const Sync sync = device_->sync();
  if (sync == Sync::host || !desc_.semaphores.empty()) return;
  const bool timeline = sync == Sync::timeline;
  semaphores_.resize(timeline ? 1 : desc_.images);
  for (Semaphores& pair : semaphores_) {
    pair.released = make_semaphore(*device_, timeline, shared());
    pair.rendered = make_semaphore(*device_, timeline, shared());
  }
}

void Ring::make_slot(uint32_t index) {
  Slot& slot = slots_[index];
  const auto make = [&](VkFormat format) {
    return make_image(*device_, format, desc_.width, desc_.height, desc_.layers, shared());
  };
  if (!desc_.imported.empty()) {
    slot.image.color = desc_.imported[index].color;
    slot.image.depth = desc_.imported[index].depth;
  } else {
    if (desc_.format != ColorFormat::none) slot.color = make(vk_format(desc_.format));
    if (desc_.depth) slot.depth = make(kDepthFormat);
    slot.image.color = slot.color.image.get();
    slot.image.depth = slot.depth.image.get();
  }
  make_views(index);
  if (desc_.depth_limit && shared())
    slot.depth_limit = make_exported_buffer(
        *device_, uint64_t{desc_.width} * desc_.height * desc_.layers * sizeof(float));

  const size_t pair = device_->sync() == Sync::binary ? index : 0;
  if (!desc_.semaphores.empty()) {
    slot.image.released = desc_.semaphores[pair].released;
    slot.image.rendered = desc_.semaphores[pair].rendered;
  } else if (!semaphores_.empty()) {
    slot.image.released = semaphores_[pair].released.get();
    slot.image.rendered = semaphores_[pair].rendered.get();
  }
}

void Ring::make_views(uint32_t index) {
  Slot& slot = slots_[index];
  const auto sampled = [&](VkImageUsageFlags usage) {
    return desc_.imported.empty() || (usage & VK_IMAGE_USAGE_SAMPLED_BIT) != 0;
  };
  const ImportedImage none;
  const ImportedImage& passed = desc_.imported.empty() ? none : desc_.imported[index];
  if (slot.image.color != VK_NULL_HANDLE && sampled(passed.color_usage))
    slot.color_view = make_view(*device_, slot.image.color, vk_format(desc_.format), desc_.layers);
  if (slot.image.depth != VK_NULL_HANDLE && sampled(passed.depth_usage))
    slot.depth_view = make_view(*device_, slot.image.depth, kDepthFormat, desc_.layers);
  slot.image.color_view = slot.color_view.get();
  slot.image.depth_view = slot.depth_view.get();
  descriptors_.set(*device_, index, slot.image.color_view, slot.image.depth_view);
}

ExternalSlot Ring::external_slot(uint32_t index) const {
  const Slot& slot = slots_[index];
  const auto own = [&](VkDeviceMemory memory, uint64_t bytes) {
    return ExternalMemory{export_memory(*device_, memory), bytes, 0, true};
  };
  ExternalSlot out;
  if (!desc_.imported.empty()) {
    const ImportedImage& passed = desc_.imported[index];
    if (passed.color != VK_NULL_HANDLE)
      out.color = {external_memory(passed.color_memory, "colorMemory"),
                   is_attachment(passed.color_usage)};
    if (passed.depth != VK_NULL_HANDLE)
      out.depth = {external_memory(passed.depth_memory, "depthMemory"),
                   is_attachment(passed.depth_usage)};
  } else {
    if (slot.image.color != VK_NULL_HANDLE)
      out.color.memory = own(slot.color.memory.get(), slot.color.bytes);
    if (slot.image.depth != VK_NULL_HANDLE)
      out.depth.memory = own(slot.depth.memory.get(), slot.depth.bytes);
  }
  if (desc_.depth_limit)
    out.depth_limit = own(slot.depth_limit.memory.get(), slot.depth_limit.bytes);
  const Sync sync = device_->sync();
  if (sync == Sync::host || (sync == Sync::timeline && index != 0)) return out;
  if (!desc_.semaphores.empty()) {
    out.released = copy_descriptor(desc_.semaphores[index].released_fd, "semaphores.released");
    out.rendered = copy_descriptor(desc_.semaphores[index].rendered_fd, "semaphores.rendered");
  } else {
    out.released = export_semaphore(*device_, semaphores_[index].released.get());
    out.rendered = export_semaphore(*device_, semaphores_[index].rendered.get());
  }
  return out;
}

void Ring::share(const ImportRing& import) {
  ExternalRingDesc desc;
  desc.format = desc_.format;
  desc.width = desc_.width;
  desc.height = desc_.height;
  desc.layers = desc_.layers;
  desc.depth = desc_.depth;
  desc.depth_limit = desc_.depth_limit;
  if (device_->sync() == Sync::timeline) desc.sync = ExternalSync::timeline;
  if (device_->sync() == Sync::binary) desc.sync = ExternalSync::binary;
  for (uint32_t i = 0; i < desc_.images; ++i) desc.slots.push_back(external_slot(i));
  external_ = import(std::move(desc));
}

RingImage Ring::image(uint32_t index) const {
  return slots_[index].image;
}

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
  bool released = device_->sync() != Sync::timeline;
  while (!external_->idle()) {
    std::this_thread::sleep_for(std::chrono::microseconds(200));
    const auto waited = std::chrono::steady_clock::now() - start;
    if (!released && waited >= desc_.patience_at_end) released = release_in_the_hosts_stead();
    if (waited >= 5 * desc_.patience_at_end) return false;
  }
  return true;
}

}  // namespace voyager::vulkan
