// A ring that is shared with the backend: its memory and semaphores by file descriptor.
#include <fcntl.h>

#include <cerrno>
#include <cstring>
#include <string>

#include "runtime/base/error.h"
#include "vulkan_interop/ring.h"

namespace voyager::vulkan {
namespace {

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

}  // namespace

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

}  // namespace voyager::vulkan
