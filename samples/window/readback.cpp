#include "readback.h"

namespace host {

Readback::Readback(const Device& device, VkExtent2D extent, bool with_depth)
    : extent_(extent),
      colour_(device, VkDeviceSize{4} * extent.width * extent.height,
              VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  if (with_depth) depth_ = Buffer(device, colour_.size, VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

void Readback::record(VkCommandBuffer commands, const RenderTargets& targets) const {
  VkBufferMemoryBarrier barriers[2];
  uint32_t count = 0;
  const auto copy = [&](const Image& image, VkImageAspectFlags aspect, const Buffer& into) {
    const VkBufferImageCopy region = {
        0, 0, 0, {aspect, 0, 0, 1}, {0, 0, 0}, {extent_.width, extent_.height, 1}};
    vkCmdCopyImageToBuffer(commands, image.image.get(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL,
                           into.buffer.get(), 1, &region);
    barriers[count++] = {VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER,
                         nullptr,
                         VK_ACCESS_TRANSFER_WRITE_BIT,
                         VK_ACCESS_HOST_READ_BIT,
                         VK_QUEUE_FAMILY_IGNORED,
                         VK_QUEUE_FAMILY_IGNORED,
                         into.buffer.get(),
                         0,
                         VK_WHOLE_SIZE};
  };
  copy(targets.colour, VK_IMAGE_ASPECT_COLOR_BIT, colour_);
  if (depth_.mapped) copy(targets.depth, VK_IMAGE_ASPECT_DEPTH_BIT, depth_);
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 0,
                       nullptr, count, barriers, 0, nullptr);
}

std::span<const uint8_t> Readback::rgba() const {
  return {reinterpret_cast<const uint8_t*>(colour_.mapped), colour_.size};
}

std::span<const float> Readback::depth() const {
  return {reinterpret_cast<const float*>(depth_.mapped), depth_.size / sizeof(float)};
}

}  // namespace host
