#include "frame_commands.h"

#include "failure.h"

namespace host {
namespace {

UniqueFence make_fence(VkDevice device, VkFenceCreateFlags flags) {
  const VkFenceCreateInfo info = {VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, flags};
  VkFence fence = VK_NULL_HANDLE;
  check(vkCreateFence(device, &info, nullptr, &fence), "vkCreateFence");
  return {device, fence};
}

void wait_for(VkDevice device, VkFence fence) {
  check(vkWaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
}

VkCommandBuffer begin(VkCommandBuffer commands) {
  VkCommandBufferBeginInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &info), "vkBeginCommandBuffer");
  return commands;
}

}  // namespace

FrameCommands::FrameCommands(const Gpu& gpu) : gpu_(gpu) {
  const VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                             VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                             gpu.queue_family};
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(gpu.device, &pool_info, nullptr, &pool), "vkCreateCommandPool");
  pool_ = {gpu.device, pool};
  const VkCommandBufferAllocateInfo info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr,
                                            pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  for (Slot& slot : slots_) {
    for (VkCommandBuffer* commands : {&slot.before, &slot.after})
      check(vkAllocateCommandBuffers(gpu.device, &info, commands), "vkAllocateCommandBuffers");
    slot.before_done = make_fence(gpu.device, 0);
    slot.after_done = make_fence(gpu.device, VK_FENCE_CREATE_SIGNALED_BIT);
  }
}

FrameCommands::~FrameCommands() {
  vkDeviceWaitIdle(gpu_.device);
}

uint32_t FrameCommands::wait_for_slot() const {
  wait_for(gpu_.device, slots_[slot_].after_done.get());
  return slot_;
}

VkCommandBuffer FrameCommands::begin_before() const {
  return begin(slots_[slot_].before);
}

VkCommandBuffer FrameCommands::begin_after() const {
  return begin(slots_[slot_].after);
}

void FrameCommands::submit_before(const Submission& submission, bool host_waits) {
  check(vkEndCommandBuffer(slots_[slot_].before), "vkEndCommandBuffer");
  if (!host_waits) return submission.submit(gpu_.queue, VK_NULL_HANDLE);
  const VkFence fence = slots_[slot_].before_done.get();
  submission.submit(gpu_.queue, fence);
  wait_for(gpu_.device, fence);
  check(vkResetFences(gpu_.device, 1, &fence), "vkResetFences");
}

void FrameCommands::submit_after(const Submission& submission) {
  check(vkEndCommandBuffer(slots_[slot_].after), "vkEndCommandBuffer");
  const VkFence fence = slots_[slot_].after_done.get();
  check(vkResetFences(gpu_.device, 1, &fence), "vkResetFences");
  submission.submit(gpu_.queue, fence);
  slot_ = (slot_ + 1) % kFramesInFlight;
}

}  // namespace host
