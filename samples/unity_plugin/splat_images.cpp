#include "splat_images.h"

namespace voyager_unity {

void QueueSignals::submit(int, void* signals) {
  const std::unique_ptr<QueueSignals> self(static_cast<QueueSignals*>(signals));
  VkTimelineSemaphoreSubmitInfo values[2] = {};
  VkSubmitInfo infos[2] = {};
  for (int i = 0; i < 2; ++i) {
    values[i].sType = VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO;
    infos[i].sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    infos[i].pNext = &values[i];
  }
  uint32_t count = 0;
  if (self->released_value > 0) {
    values[count].signalSemaphoreValueCount = infos[count].signalSemaphoreCount = 1;
    values[count].pSignalSemaphoreValues = &self->released_value;
    infos[count].pSignalSemaphores = &self->released;
    ++count;
  }
  const VkPipelineStageFlags everything = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
  if (self->rendered_value > 0) {
    values[count].waitSemaphoreValueCount = infos[count].waitSemaphoreCount = 1;
    values[count].pWaitSemaphoreValues = &self->rendered_value;
    infos[count].pWaitSemaphores = &self->rendered;
    infos[count].pWaitDstStageMask = &everything;
    ++count;
  }
  const VkResult result = self->queue_submit(self->queue, count, infos, VK_NULL_HANDLE);
  if (result == VK_SUCCESS && self->released_value > 0) *self->submitted = self->released_value;
}

SplatImages::SplatImages(const DeviceFunctions& functions, const voy::Device& device,
                         VkExtent2D extent, uint32_t queue_family)
    : functions_(functions), extent_(extent), queue_family_(queue_family) {
  VoyVulkanTargetDesc vulkan = VOY_VULKAN_TARGET_DESC_INIT;
  vulkan.imageCount = kImages;
  vulkan.hasDepth = VK_TRUE;
  VoyTargetDesc desc = VOY_TARGET_DESC_INIT;
  desc.next = &vulkan;
  desc.kind = VOY_TARGET_KIND_VULKAN;
  desc.width = extent.width;
  desc.height = extent.height;
  target_ = device.create_target(desc);
  VoyVulkanImage images[kImages];
  uint32_t count = 0;
  voy::check(voyGetVulkanImages(target_.get(), kImages, images, &count));
  released_semaphore_ = images[0].released;  // timelines: the same for all images
  rendered_semaphore_ = images[0].rendered;
}

VoyVulkanUse SplatImages::use(VkCommandBuffer commands, uint32_t image) const {
  VoyVulkanUse use = VOY_VULKAN_USE_INIT;  // sampled in a fragment shader
  use.commandBuffer = commands;
  use.queueFamily = queue_family_;
  use.imageIndex = image;
  return use;
}

void SplatImages::record_first_release(VkCommandBuffer commands) {
  for (uint32_t i = 0; i < kImages; ++i) record_release(commands, i);
}

std::optional<VoyVulkanFrame> SplatImages::next_frame() const {
  VoyVulkanFrame frame = VOY_VULKAN_FRAME_INIT;
  frame.imageIndex = static_cast<uint32_t>(frames_ % kImages);
  frame.waitValue = released_at_[frame.imageIndex];
  frame.signalValue = frames_ + 1;
  if (*submitted_ < frame.waitValue) return std::nullopt;
  return frame;
}

std::unique_ptr<QueueSignals> SplatImages::queue_signals(VkQueue queue) {
  auto signals = std::make_unique<QueueSignals>();
  signals->queue_submit = functions_.queue_submit;
  signals->queue = queue;
  signals->released = released_semaphore_;
  signals->rendered = rendered_semaphore_;
  signals->released_value = released_since_ ? ++signals_ : 0;
  signals->rendered_value = frames_ > waits_ ? frames_ : 0;
  signals->submitted = submitted_;
  released_since_ = false;
  waits_ = frames_;
  return signals;
}

uint32_t SplatImages::record_acquire(VkCommandBuffer commands) {
  const auto image = static_cast<uint32_t>((frames_ - 1) % kImages);
  const VoyVulkanUse acquired = use(commands, image);
  voy::check(voyRecordVulkanAcquire(target_.get(), &acquired));
  return image;
}

void SplatImages::record_release(VkCommandBuffer commands, uint32_t image) {
  const VoyVulkanUse released = use(commands, image);
  voy::check(voyRecordVulkanRelease(target_.get(), &released));
  released_at_[image] = signals_ + 1;
  released_since_ = true;
}

}  // namespace voyager_unity
