#pragma once
// What was recorded into a command buffer.
#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <vulkan/vulkan_core.h>

#include <cstddef>
#include <vector>

namespace voyager::test {

struct Command {
  enum Kind {
    barrier,
    copy_image,
    blit_image,
    buffer_to_image,
    image_to_buffer,
    bind_pipeline,
    bind_sets,
    push_constants,
    viewport,
    scissor,
    draw
  };
  explicit Command(Kind what, VkCommandBuffer into) : kind(what), commands(into) {}

  Kind kind;
  VkCommandBuffer commands;
  VkPipelineStageFlags from_stages = 0, to_stages = 0;
  std::vector<VkImageMemoryBarrier> images;
  std::vector<VkBufferMemoryBarrier> buffers;
  VkImage from = VK_NULL_HANDLE, to = VK_NULL_HANDLE;
  VkImageLayout from_layout = VK_IMAGE_LAYOUT_UNDEFINED, to_layout = VK_IMAGE_LAYOUT_UNDEFINED;
  VkBuffer buffer = VK_NULL_HANDLE;
  VkBufferImageCopy region{};
  VkImageCopy image_region{};
  VkImageBlit blit_region{};
  VkPipeline pipeline = VK_NULL_HANDLE;
  VkDescriptorSet set = VK_NULL_HANDLE;
  std::vector<std::byte> pushed;
};

}  // namespace voyager::test
