#include "image_copy.h"

namespace host {

void copy_to_host(VkCommandBuffer commands, VkImage from, VkImageAspectFlags aspect,
                  VkExtent2D extent, const Buffer& into) {
  const VkBufferImageCopy region = {
      0, 0, 0, {aspect, 0, 0, 1}, {0, 0, 0}, {extent.width, extent.height, 1}};
  vkCmdCopyImageToBuffer(commands, from, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, into.buffer.get(), 1,
                         &region);
  const VkBufferMemoryBarrier barrier = {VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER,
                                         nullptr,
                                         VK_ACCESS_TRANSFER_WRITE_BIT,
                                         VK_ACCESS_HOST_READ_BIT,
                                         VK_QUEUE_FAMILY_IGNORED,
                                         VK_QUEUE_FAMILY_IGNORED,
                                         into.buffer.get(),
                                         0,
                                         VK_WHOLE_SIZE};
  vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT, 0, 0,
                       nullptr, 1, &barrier, 0, nullptr);
}

}  // namespace host
