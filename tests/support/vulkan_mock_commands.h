#pragma once
// Entry points of VulkanMock that record.
#include "tests/support/vulkan_mock_device.h"

namespace voyager::test::mock {

inline Command& record(Command::Kind kind, VkCommandBuffer commands) {
  return VulkanMock::current->commands.emplace_back(kind, commands);
}

inline void barrier(VkCommandBuffer commands, VkPipelineStageFlags from, VkPipelineStageFlags to,
                    VkDependencyFlags, uint32_t, const VkMemoryBarrier*, uint32_t buffer_count,
                    const VkBufferMemoryBarrier* buffers, uint32_t image_count,
                    const VkImageMemoryBarrier* images) {
  Command& made = record(Command::barrier, commands);
  made.from_stages = from;
  made.to_stages = to;
  made.images.assign(images, images + image_count);
  made.buffers.assign(buffers, buffers + buffer_count);
}

inline Command& image_to_image(Command::Kind kind, VkCommandBuffer commands, VkImage from,
                               VkImageLayout from_layout, VkImage to, VkImageLayout to_layout,
                               uint32_t count) {
  EXPECT_EQ(count, 1u);
  Command& made = record(kind, commands);
  made.from = from;
  made.from_layout = from_layout;
  made.to = to;
  made.to_layout = to_layout;
  return made;
}
inline void copy_image(VkCommandBuffer commands, VkImage from, VkImageLayout from_layout,
                       VkImage to, VkImageLayout to_layout, uint32_t count,
                       const VkImageCopy* regions) {
  image_to_image(Command::copy_image, commands, from, from_layout, to, to_layout, count)
      .image_region = regions[0];
}
inline void blit_image(VkCommandBuffer commands, VkImage from, VkImageLayout from_layout,
                       VkImage to, VkImageLayout to_layout, uint32_t count,
                       const VkImageBlit* regions, VkFilter filter) {
  EXPECT_EQ(filter, VK_FILTER_NEAREST);
  image_to_image(Command::blit_image, commands, from, from_layout, to, to_layout, count)
      .blit_region = regions[0];
}
inline void buffer_to_image(VkCommandBuffer commands, VkBuffer buffer, VkImage to,
                            VkImageLayout layout, uint32_t count,
                            const VkBufferImageCopy* regions) {
  EXPECT_EQ(count, 1u);
  Command& made = record(Command::buffer_to_image, commands);
  made.buffer = buffer;
  made.to = to;
  made.to_layout = layout;
  made.region = regions[0];
}
inline void image_to_buffer(VkCommandBuffer commands, VkImage from, VkImageLayout layout,
                            VkBuffer buffer, uint32_t count, const VkBufferImageCopy* regions) {
  EXPECT_EQ(count, 1u);
  Command& made = record(Command::image_to_buffer, commands);
  made.from = from;
  made.from_layout = layout;
  made.buffer = buffer;
  made.region = regions[0];
}

inline void bind_pipeline(VkCommandBuffer commands, VkPipelineBindPoint, VkPipeline pipeline) {
  EXPECT_TRUE(VulkanMock::current->has(pipeline));
  record(Command::bind_pipeline, commands).pipeline = pipeline;
}
inline void bind_sets(VkCommandBuffer commands, VkPipelineBindPoint, VkPipelineLayout layout,
                      uint32_t, uint32_t, const VkDescriptorSet* sets, uint32_t, const uint32_t*) {
  EXPECT_TRUE(VulkanMock::current->has(layout));
  record(Command::bind_sets, commands).set = sets[0];
}
inline void push_constants(VkCommandBuffer commands, VkPipelineLayout, VkShaderStageFlags, uint32_t,
                           uint32_t bytes, const void* values) {
  const auto* first = static_cast<const std::byte*>(values);
  record(Command::push_constants, commands).pushed.assign(first, first + bytes);
}
inline void set_viewport(VkCommandBuffer commands, uint32_t, uint32_t, const VkViewport*) {
  record(Command::viewport, commands);
}
inline void set_scissor(VkCommandBuffer commands, uint32_t, uint32_t, const VkRect2D*) {
  record(Command::scissor, commands);
}
inline void draw(VkCommandBuffer commands, uint32_t, uint32_t, uint32_t, uint32_t) {
  record(Command::draw, commands);
}

}  // namespace voyager::test::mock
