#include "splat_images.h"

namespace voyager_godot {
namespace {

constexpr uint64_t kSecond = 1'000'000'000;

VkImageMemoryBarrier barrier(VkImage image, VkImageLayout from, VkImageLayout to,
                             VkAccessFlags before, VkAccessFlags after) {
  VkImageMemoryBarrier out = {};
  out.sType = VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER;
  out.srcAccessMask = before;
  out.dstAccessMask = after;
  out.oldLayout = from;
  out.newLayout = to;
  out.srcQueueFamilyIndex = out.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  out.image = image;
  out.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1};
  return out;
}

}  // namespace

SplatImages::SplatImages(const DeviceFunctions& functions, const voy::Device& device,
                         const NativeDevice& native, VkExtent2D extent)
    : functions_(functions), native_(native), extent_(extent) {
  VoyVulkanTargetDesc vulkan = VOY_VULKAN_TARGET_DESC_INIT;
  vulkan.imageCount = kImages;
  vulkan.hasDepth = VK_TRUE;
  VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
  desc.next = &vulkan;
  desc.kind = VOY_TARGET_KIND_VULKAN;
  desc.width = extent.width;
  desc.height = extent.height;
  target_ = device.create_target(desc);
  uint32_t count = 0;
  voy::check(voyGetVulkanImages(target_.get(), kImages, images_, &count));
  try {
    create_slots();
  } catch (...) {
    destroy();
    throw;
  }
}

SplatImages::~SplatImages() {
  destroy();
}

// Each image is handed to Voyager once, before its first frame.
void SplatImages::create_slots() {
  const VkCommandPoolCreateInfo pool = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                        VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                        native_.queue_family};
  check(functions_.create_command_pool(functions_.device, &pool, nullptr, &pool_),
        "vkCreateCommandPool");
  for (uint32_t image = 0; image < kImages; ++image) {
    const VkCommandBufferAllocateInfo buffers = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                                 nullptr, pool_, VK_COMMAND_BUFFER_LEVEL_PRIMARY,
                                                 1};
    check(functions_.allocate_command_buffers(functions_.device, &buffers, &slots_[image].commands),
          "vkAllocateCommandBuffers");
    const VkFenceCreateInfo fence = {VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr,
                                     VK_FENCE_CREATE_SIGNALED_BIT};
    check(functions_.create_fence(functions_.device, &fence, nullptr, &slots_[image].fence),
          "vkCreateFence");
    begin(image);
    const VoyVulkanUse released = use(image);
    voy::check(voyRecordVulkanRelease(target_.get(), &released));
    submit(image);
  }
}

void SplatImages::destroy() {
  for (Slot& slot : slots_) {
    if (!slot.fence) continue;
    functions_.wait_for_fences(functions_.device, 1, &slot.fence, VK_TRUE, 10 * kSecond);
    functions_.destroy_fence(functions_.device, slot.fence, nullptr);
  }
  functions_.destroy_command_pool(functions_.device, pool_, nullptr);
  target_ = {};
}

void SplatImages::wait(uint32_t image) const {
  check(functions_.wait_for_fences(functions_.device, 1, &slots_[image].fence, VK_TRUE, kSecond),
        "vkWaitForFences");
}

VkCommandBuffer SplatImages::begin(uint32_t image) {
  VkCommandBufferBeginInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(functions_.reset_command_buffer(slots_[image].commands, 0), "vkResetCommandBuffer");
  check(functions_.begin_command_buffer(slots_[image].commands, &info), "vkBeginCommandBuffer");
  return slots_[image].commands;
}

void SplatImages::submit(uint32_t image) {
  Slot& slot = slots_[image];
  check(functions_.end_command_buffer(slot.commands), "vkEndCommandBuffer");
  VkSubmitInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  info.commandBufferCount = 1;
  info.pCommandBuffers = &slot.commands;
  check(functions_.reset_fences(functions_.device, 1, &slot.fence), "vkResetFences");
  check(functions_.queue_submit(native_.queue, 1, &info, slot.fence), "vkQueueSubmit");
}

VoyVulkanUse SplatImages::use(uint32_t image) const {
  VoyVulkanUse use = VOY_VULKAN_USE_INIT;
  use.commandBuffer = slots_[image].commands;
  use.queueFamily = native_.queue_family;
  use.imageIndex = image;
  use.layout = VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL;
  use.stages = VK_PIPELINE_STAGE_TRANSFER_BIT;
  return use;
}

void SplatImages::draw(voy::View& view, VoyFrame frame, const GodotTextures& into) {
  const uint32_t image = next_;
  wait(image);
  VoyVulkanFrame vulkan = VOY_VULKAN_FRAME_INIT;
  vulkan.imageIndex = image;
  frame.next = &vulkan;
  view.render(frame);
  next_ = (next_ + 1) % kImages;
  const VkCommandBuffer commands = begin(image);
  const VoyVulkanUse handed = use(image);
  voy::check(voyRecordVulkanAcquire(target_.get(), &handed));
  record_copies(commands, image, into);
  voy::check(voyRecordVulkanRelease(target_.get(), &handed));
  submit(image);
}

void SplatImages::record_copies(VkCommandBuffer commands, uint32_t image,
                                const GodotTextures& into) const {
  const VkImage from[] = {images_[image].color, images_[image].depth};
  const VkImage to[] = {into.colour, into.depth};
  constexpr VkImageLayout kSampled = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL,
                          kWritten = VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL;
  VkImageMemoryBarrier before[2], after[2];
  for (int i = 0; i < 2; ++i) {
    before[i] = barrier(to[i], kSampled, kWritten, 0, VK_ACCESS_TRANSFER_WRITE_BIT);
    after[i] =
        barrier(to[i], kWritten, kSampled, VK_ACCESS_TRANSFER_WRITE_BIT, VK_ACCESS_SHADER_READ_BIT);
  }
  functions_.pipeline_barrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                              VK_PIPELINE_STAGE_TRANSFER_BIT, 0, 0, nullptr, 0, nullptr, 2, before);
  const VkImageSubresourceLayers layer = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
  const VkImageCopy whole = {
      layer, {0, 0, 0}, layer, {0, 0, 0}, {extent_.width, extent_.height, 1}};
  for (int i = 0; i < 2; ++i)
    functions_.copy_image(commands, from[i], VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to[i], kWritten,
                          1, &whole);
  functions_.pipeline_barrier(commands, VK_PIPELINE_STAGE_TRANSFER_BIT,
                              VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 2,
                              after);
}

}  // namespace voyager_godot
