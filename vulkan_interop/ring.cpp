#include "vulkan_interop/ring.h"

#include <string>

#include "runtime/base/error.h"
#include "vulkan_interop/formats.h"

namespace voyager::vulkan {
namespace {

void check_usage(VkImageUsageFlags usage, const std::string& field) {
  if ((usage & VK_IMAGE_USAGE_TRANSFER_DST_BIT) == 0)
    throw Error(ErrorCode::invalid_argument,
                field + ": found " + std::to_string(usage) +
                    ", expected VK_IMAGE_USAGE_TRANSFER_DST_BIT among it for HOST sharing");
}

// That the image can lie where the host says that it does.
void check_room(const Device& device, VkImage image, const ImportedMemory& memory,
                const std::string& field) {
  VkMemoryRequirements needs;
  device.functions().GetImageMemoryRequirements(device.handle(), image, &needs);
  if (memory.offset % needs.alignment == 0 && memory.offset <= memory.size &&
      needs.size <= memory.size - memory.offset)
    return;
  throw Error(ErrorCode::invalid_argument,
              field + ": found offset " + std::to_string(memory.offset) + " in " +
                  std::to_string(memory.size) + " bytes, expected a multiple of " +
                  std::to_string(needs.alignment) + " with the image's " +
                  std::to_string(needs.size) + " bytes from there");
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
  if (abandoned_ || !finish()) static_cast<void>(external_.release());
}

void Ring::check_imported() const {
  // plane: "color" or "depth", as its fields' names begin.
  const auto check = [&](VkImage image, const ImportedMemory& memory, VkImageUsageFlags usage,
                         const std::string& plane) {
    if (image == VK_NULL_HANDLE) return;
    if (shared())
      check_room(*device_, image, memory, plane + "Memory");
    else
      check_usage(usage, plane + "Usage");
  };
  for (size_t i = 0; i < desc_.imported.size(); ++i) {
    const ImportedImage& passed = desc_.imported[i];
    const std::string name = "images[" + std::to_string(i) + "].";
    check(passed.color, passed.color_memory, passed.color_usage, name + "color");
    check(passed.depth, passed.depth_memory, passed.depth_usage, name + "depth");
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

RingImage Ring::image(uint32_t index) const {
  return slots_[index].image;
}

}  // namespace voyager::vulkan
