#include "tools/view/frame_renderer.h"

#include "failure.h"

namespace voyager::view {
namespace {

using host::check;

host::UniqueFence make_fence(VkDevice device, VkFenceCreateFlags flags) {
  const VkFenceCreateInfo info = {VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, flags};
  VkFence fence = VK_NULL_HANDLE;
  check(vkCreateFence(device, &info, nullptr, &fence), "vkCreateFence");
  return {device, fence};
}

void wait_for(VkDevice device, VkFence fence) {
  check(vkWaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX), "vkWaitForFences");
}

void begin(VkCommandBuffer commands) {
  VkCommandBufferBeginInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &info), "vkBeginCommandBuffer");
}

void begin_pass(VkCommandBuffer commands, VkRenderPass pass, VkFramebuffer framebuffer,
                VkExtent2D extent) {
  VkClearValue clear[2] = {};
  clear[0].color = {{0.08f, 0.08f, 0.09f, 1}};  // where there is no scene
  VkRenderPassBeginInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_RENDER_PASS_BEGIN_INFO;
  info.renderPass = pass;
  info.framebuffer = framebuffer;
  info.renderArea.extent = extent;
  info.clearValueCount = 2;  // of no use to the pass that loads
  info.pClearValues = clear;
  vkCmdBeginRenderPass(commands, &info, VK_SUBPASS_CONTENTS_INLINE);
}

}  // namespace

FrameRenderer::FrameRenderer(const host::Device& device, VkFormat colour)
    : device_(device),
      colour_(colour),
      passes_(device, colour),
      screen_(device, passes_.meshes(), colour) {
  const VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                             VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                             device.queue_family()};
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(device.get(), &pool_info, nullptr, &pool), "vkCreateCommandPool");
  pool_ = {device.get(), pool};
  const VkCommandBufferAllocateInfo info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr,
                                            pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  for (Slot& slot : slots_) {
    for (VkCommandBuffer* commands : {&slot.before, &slot.after})
      check(vkAllocateCommandBuffers(device.get(), &info, commands), "vkAllocateCommandBuffers");
    slot.before_done = make_fence(device.get(), 0);
    slot.after_done = make_fence(device.get(), VK_FENCE_CREATE_SIGNALED_BIT);
  }
}

// Frames may be in flight where an error ends the program.
FrameRenderer::~FrameRenderer() {
  vkDeviceWaitIdle(device_.get());
}

void FrameRenderer::resize(VkExtent2D extent) {
  device_.wait_idle();
  targets_ = {};
  targets_ = host::RenderTargets(device_, passes_, colour_, extent);
}

uint32_t FrameRenderer::wait_for_slot() {
  wait_for(device_.get(), slots_[slot_].after_done.get());
  return slot_;
}

void FrameRenderer::draw(const FrameDesc& frame) {
  wait_for_slot();
  const Slot& slot = slots_[slot_];
  std::vector<SplatView*> drawn;
  for (SplatView* view : {frame.left, frame.right})
    if (view && frame.draw) drawn.push_back(view);
  if (!drawn.empty()) render(slot, frame, drawn);
  record_after(slot, frame, drawn);
  host::Submission submission(slot.after);
  for (const SplatView* view : drawn)
    submission.wait(view->rendered(), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
  submission.wait({frame.acquired}, VK_PIPELINE_STAGE_TRANSFER_BIT);
  submission.signal({frame.ready});
  const VkFence fence = slot.after_done.get();
  check(vkResetFences(device_.get(), 1, &fence), "vkResetFences");
  submission.submit(device_.queue(), fence);
  slot_ = (slot_ + 1) % host::kFramesInFlight;
}

void FrameRenderer::render(const Slot& slot, const FrameDesc& frame,
                           const std::vector<SplatView*>& views) {
  begin(slot.before);
  host::Submission submission(slot.before);
  for (SplatView* view : views) {
    view->release(slot.before);
    submission.signal(view->released());
  }
  check(vkEndCommandBuffer(slot.before), "vkEndCommandBuffer");
  const VkFence fence = slot.before_done.get();
  const bool host_waits = views.front()->host_waits();
  submission.submit(device_.queue(), host_waits ? fence : VK_NULL_HANDLE);
  if (host_waits) {
    wait_for(device_.get(), fence);
    check(vkResetFences(device_.get(), 1, &fence), "vkResetFences");
  }
  for (SplatView* view : views) view->render(frame.camera, frame.background, frame.wait);
}

void FrameRenderer::record_after(const Slot& slot, const FrameDesc& frame,
                                 const std::vector<SplatView*>& drawn) {
  begin(slot.after);
  for (const SplatView* view : drawn) view->acquire(slot.after);
  begin_pass(slot.after, passes_.meshes(), targets_.meshes.get(), targets_.extent);
  if (frame.left) record_screen(slot.after, frame);
  vkCmdEndRenderPass(slot.after);
  begin_pass(slot.after, passes_.overlay(), targets_.overlay.get(), targets_.extent);
  if (frame.overlay) frame.overlay(slot.after);
  vkCmdEndRenderPass(slot.after);
  frame.record(slot.after, targets_);
  check(vkEndCommandBuffer(slot.after), "vkEndCommandBuffer");
}

void FrameRenderer::record_screen(VkCommandBuffer commands, const FrameDesc& frame) {
  Screen screen;
  screen.left = screen.right = frame.left->picture();
  screen.exposure = frame.exposure;
  screen.split = static_cast<float>(targets_.extent.width) + 2;  // nowhere
  if (frame.right) screen.right = frame.right->picture();
  if (frame.still) screen.right = frame.still;
  if (frame.right || frame.still) screen.split = frame.split;
  screen_.record(commands, slot_, targets_.extent, screen);
}

}  // namespace voyager::view
