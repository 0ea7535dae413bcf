#include "readback.h"

#include "image_copy.h"

namespace host {

Readback::Readback(const Device& device, VkExtent2D extent, bool with_depth)
    : extent_(extent),
      colour_(device, VkDeviceSize{4} * extent.width * extent.height,
              VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  if (with_depth) depth_ = Buffer(device, colour_.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

void Readback::record(VkCommandBuffer commands, const RenderTargets& targets) const {
  copy_to_host(commands, targets.colour.image.get(), VK_IMAGE_ASPECT_COLOR_BIT, extent_, colour_);
  if (depth_.mapped)
    copy_to_host(commands, targets.depth.image.get(), VK_IMAGE_ASPECT_DEPTH_BIT, extent_, depth_);
}

std::span<const uint8_t> Readback::rgba() const {
  return {reinterpret_cast<const uint8_t*>(colour_.mapped), colour_.size};
}

std::span<const float> Readback::depth() const {
  return {reinterpret_cast<const float*>(depth_.mapped), depth_.size / sizeof(float)};
}

}  // namespace host
