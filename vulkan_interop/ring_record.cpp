// What a ring records into the host's command buffers.
#include <array>
#include <string>
#include <utility>

#include "runtime/base/error.h"
#include "vulkan_interop/formats.h"
#include "vulkan_interop/ring.h"

namespace voyager::vulkan {
namespace {

// Those that can read an image in a layout that a host may ask for.
constexpr VkPipelineStageFlags kShaders =
    VK_PIPELINE_STAGE_VERTEX_SHADER_BIT | VK_PIPELINE_STAGE_TESSELLATION_CONTROL_SHADER_BIT |
    VK_PIPELINE_STAGE_TESSELLATION_EVALUATION_SHADER_BIT | VK_PIPELINE_STAGE_GEOMETRY_SHADER_BIT |
    VK_PIPELINE_STAGE_FRAGMENT_SHADER_BIT | VK_PIPELINE_STAGE_COMPUTE_SHADER_BIT |
    VK_PIPELINE_STAGE_ALL_GRAPHICS_BIT | VK_PIPELINE_STAGE_TASK_SHADER_BIT_NV |
    VK_PIPELINE_STAGE_MESH_SHADER_BIT_NV | VK_PIPELINE_STAGE_RAY_TRACING_SHADER_BIT_KHR;

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::invalid_argument, what);
}

VkImageMemoryBarrier image_barrier(VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier barrier{};
  barrier.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  barrier.oldLayout = from;
  barrier.newLayout = to;
  barrier.srcQueueFamilyIndex = barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  return barrier;
}

// Reads that the host's stages can make.
VkAccessFlags reads_of(VkPipelineStageFlags stages) {
  if ((stages & VK_PIPELINE_STAGE_ALL_COMMANDS_BIT) != 0) return VK_ACCESS_MEMORY_READ_BIT;
  VkAccessFlags access = 0;
  if ((stages & kShaders) != 0) access |= VK_ACCESS_SHADER_READ_BIT;
  if ((stages & VK_PIPELINE_STAGE_TRANSFER_BIT) != 0) access |= VK_ACCESS_TRANSFER_READ_BIT;
  if (access == 0)
    refuse("use.stages: found " + std::to_string(stages) +
           ", expected one that reads images: a shader's, TRANSFER, ALL_GRAPHICS or ALL_COMMANDS");
  return access;
}

VkImageSubresourceLayers layer_of(uint32_t layer, VkImageAspectFlags aspect) {
  return {aspect, 0, layer, 1};
}

bool has_same_bits(VkFormat into, VkFormat own) {
  return into == own || (own == VK_FORMAT_R8G8B8A8_UNORM && into == VK_FORMAT_R8G8B8A8_SRGB);
}

VkImageAspectFlags limit_aspect(VkFormat format) {
  switch (format) {
    case VK_FORMAT_D32_SFLOAT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return VK_IMAGE_ASPECT_DEPTH_BIT;
    case VK_FORMAT_R32_SFLOAT:
      return VK_IMAGE_ASPECT_COLOR_BIT;
    default:
      throw Error(ErrorCode::unsupported,
                  "VoyVulkanDepthLimit.depthFormat: found VkFormat " + std::to_string(format) +
                      ", expected D32_SFLOAT, D32_SFLOAT_S8_UINT or R32_SFLOAT");
  }
}

}  // namespace

void Ring::check_family(uint32_t family) const {
  const uint32_t families = device_->physical().queue_families();
  if (family >= families)
    refuse("queueFamily: found " + std::to_string(family) + ", expected one of the device's " +
           std::to_string(families) + " queue families");
}

void Ring::transition(const Slot& slot, VkCommandBuffer commands, VkPipelineStageFlags from,
                      VkPipelineStageFlags to, VkImageMemoryBarrier barrier) const {
  std::array<VkImageMemoryBarrier, 2> barriers;
  uint32_t count = 0;
  barrier.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, desc_.layers};
  for (const VkImage image : {slot.image.color, slot.image.depth}) {
    if (image == VK_NULL_HANDLE) continue;
    barrier.image = image;
    barriers[count++] = barrier;
  }
  device_->functions().CmdPipelineBarrier(commands, from, to, 0, 0, nullptr, 0, nullptr, count,
                                          barriers.data());
}

void Ring::record_release(uint32_t index, const Use& use) {
  check_family(use.queue_family);
  Slot& slot = slots_[index];
  if (slot.holder == Holder::host && use.layout != slot.layout)
    refuse("use.layout: found VkImageLayout " + std::to_string(use.layout) + " for image " +
           std::to_string(index) + ", expected that of its last acquire, " +
           std::to_string(slot.layout));
  const Holder from = std::exchange(slot.holder, Holder::voyager);
  slot.last_stages = use.stages;
  // Staging memory needs nothing; an image that the host did not take is here still.
  if (!shared() || from == Holder::voyager) return;
  VkImageMemoryBarrier barrier = image_barrier(
      from == Holder::host ? use.layout : VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_GENERAL);
  barrier.srcQueueFamilyIndex = use.queue_family;
  barrier.dstQueueFamilyIndex = VK_QUEUE_FAMILY_EXTERNAL;
  transition(slot, use.commands, use.stages, VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, barrier);
}

void Ring::record_acquire(uint32_t index, const Use& use) {
  check_family(use.queue_family);
  check_released(index, "use.imageIndex");
  const VkAccessFlags reads = reads_of(use.stages);
  Slot& slot = slots_[index];
  slot.holder = Holder::host;
  slot.layout = use.layout;
  if (!shared()) {
    copy_from_staging(index, use);
    slot.last_stages = use.stages;
    return;
  }
  VkImageMemoryBarrier barrier = image_barrier(VK_IMAGE_LAYOUT_GENERAL, use.layout);
  barrier.srcQueueFamilyIndex = VK_QUEUE_FAMILY_EXTERNAL;
  barrier.dstQueueFamilyIndex = use.queue_family;
  barrier.dstAccessMask = reads;
  // The stages at which the submission waits for `rendered`.
  transition(slot, use.commands, VK_PIPELINE_STAGE_TRANSFER_BIT | use.stages, use.stages, barrier);
}

void Ring::copy_from_staging(uint32_t index, const Use& use) const {
  const DeviceFunctions& vk = device_->functions();
  const Slot& slot = slots_[index];
  VkBufferMemoryBarrier written{};
  written.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER;
  written.srcAccessMask = VK_ACCESS_HOST_WRITE_BIT;
  written.dstAccessMask = VK_ACCESS_TRANSFER_READ_BIT;
  written.srcQueueFamilyIndex = written.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  written.buffer = staging_->buffer();
  written.size = VK_WHOLE_SIZE;
  vk.CmdPipelineBarrier(use.commands, VK_PIPELINE_STAGE_HOST_BIT, VK_PIPELINE_STAGE_TRANSFER_BIT, 0,
                        0, nullptr, 1, &written, 0, nullptr);
  VkImageMemoryBarrier barrier =
      image_barrier(VK_IMAGE_LAYOUT_UNDEFINED, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
  barrier.dstAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  transition(slot, use.commands, VK_PIPELINE_STAGE_TRANSFER_BIT | slot.last_stages,
             VK_PIPELINE_STAGE_TRANSFER_BIT, barrier);
  const auto copy = [&](VkImage image, uint32_t layer, uint64_t offset) {
    if (image == VK_NULL_HANDLE) return;
    const VkBufferImageCopy region{offset,    0,
                                   0,         layer_of(layer, VK_IMAGE_ASPECT_COLOR_BIT),
                                   {0, 0, 0}, {desc_.width, desc_.height, 1}};
    vk.CmdCopyBufferToImage(use.commands, staging_->buffer(), image,
                            VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
  };
  for (uint32_t layer = 0; layer < desc_.layers; ++layer) {
    copy(slot.image.color, layer, staging_->color_at(index, layer));
    copy(slot.image.depth, layer, staging_->depth_at(index, layer));
  }
  barrier = image_barrier(VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, use.layout);
  barrier.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  barrier.dstAccessMask = reads_of(use.stages);
  transition(slot, use.commands, VK_PIPELINE_STAGE_TRANSFER_BIT, use.stages, barrier);
}

void Ring::record_copy(uint32_t index, uint32_t layer, const CopyTo& to) const {
  const DeviceFunctions& vk = device_->functions();
  const VkImage image = slots_[index].image.color;
  const VkFormat own = vk_format(desc_.format);
  const VkImageSubresourceLayers from = layer_of(layer, VK_IMAGE_ASPECT_COLOR_BIT);
  const VkImageSubresourceLayers into = layer_of(to.layer, VK_IMAGE_ASPECT_COLOR_BIT);
  const VkOffset3D first{to.offset.x, to.offset.y, 0};
  if (image != VK_NULL_HANDLE && has_same_bits(to.format, own)) {
    const VkImageCopy region{from, {0, 0, 0}, into, first, {desc_.width, desc_.height, 1}};
    vk.CmdCopyImage(to.commands, image, to.layout, to.image, to.image_layout, 1, &region);
    return;
  }
  if (own != VK_FORMAT_R8G8B8A8_UNORM || to.format != VK_FORMAT_B8G8R8A8_UNORM)
    throw Error(ErrorCode::unsupported,
                "VoyVulkanCopy.intoFormat: found VkFormat " + std::to_string(to.format) +
                    ", which cannot be copied to from VkFormat " + std::to_string(own) +
                    " as it is; voyRecordVulkanComposite draws into others");
  const auto width = static_cast<int32_t>(desc_.width);
  const auto height = static_cast<int32_t>(desc_.height);
  const VkImageBlit region{
      from, {{0, 0, 0}, {width, height, 1}}, into, {first, {first.x + width, first.y + height, 1}}};
  vk.CmdBlitImage(to.commands, image, to.layout, to.image, to.image_layout, 1, &region,
                  VK_FILTER_NEAREST);
}

void Ring::record_depth_limit(uint32_t index, uint32_t layer, const LimitFrom& from) const {
  check_family(from.queue_family);
  const DeviceFunctions& vk = device_->functions();
  const VkImageAspectFlags aspect = limit_aspect(from.format);
  const uint64_t plane = uint64_t{desc_.width} * desc_.height * sizeof(float);
  const VkBuffer buffer = shared() ? slots_[index].depth_limit.buffer.get() : staging_->buffer();
  const uint64_t offset = shared() ? layer * plane : staging_->limit_at(index, layer);
  const VkBufferImageCopy region{offset,
                                 0,
                                 0,
                                 layer_of(from.layer, aspect),
                                 {from.offset.x, from.offset.y, 0},
                                 {desc_.width, desc_.height, 1}};
  vk.CmdCopyImageToBuffer(from.commands, from.depth, from.layout, buffer, 1, &region);
  VkBufferMemoryBarrier written{};
  written.sType = VK_STRUCTURE_TYPE_BUFFER_MEMORY_BARRIER;
  written.srcAccessMask = VK_ACCESS_TRANSFER_WRITE_BIT;
  written.srcQueueFamilyIndex = written.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  written.buffer = buffer;
  written.offset = offset;
  written.size = plane;
  if (!shared()) {
    written.dstAccessMask = VK_ACCESS_HOST_READ_BIT;
    vk.CmdPipelineBarrier(from.commands, VK_PIPELINE_STAGE_TRANSFER_BIT, VK_PIPELINE_STAGE_HOST_BIT,
                          0, 0, nullptr, 1, &written, 0, nullptr);
    return;
  }
  written.srcQueueFamilyIndex = from.queue_family;
  written.dstQueueFamilyIndex = VK_QUEUE_FAMILY_EXTERNAL;
  vk.CmdPipelineBarrier(from.commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                        VK_PIPELINE_STAGE_BOTTOM_OF_PIPE_BIT, 0, 0, nullptr, 1, &written, 0,
                        nullptr);
}

}  // namespace voyager::vulkan
