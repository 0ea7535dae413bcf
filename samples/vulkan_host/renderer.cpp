#include "renderer.h"

#include "failure.h"
#include "submission.h"

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

void begin(VkCommandBuffer commands) {
  VkCommandBufferBeginInfo info = {};
  info.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  check(vkBeginCommandBuffer(commands, &info), "vkBeginCommandBuffer");
}

void end(VkCommandBuffer commands) {
  check(vkEndCommandBuffer(commands), "vkEndCommandBuffer");
}

void begin_pass(VkCommandBuffer commands, VkRenderPass pass, VkFramebuffer framebuffer,
                VkExtent2D extent, const DepthConvention& depth) {
  VkClearValue clear[2] = {};
  clear[0].color = {{0, 0, 0, 1}};
  clear[1].depthStencil = {static_cast<float>(depth.far_plane()), 0};
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

Renderer::Renderer(const Device& device, VoyagerLayer& voyager, VkFormat colour_format,
                   const DepthConvention& depth, const Mesh* mesh, const glm::dmat4& mesh_place)
    : device_(device),
      voyager_(voyager),
      colour_format_(colour_format),
      depth_(depth),
      mesh_place_(mesh_place),
      passes_(device, colour_format) {
  if (mesh) meshes_.emplace(device, passes_.meshes(), colour_format, depth.encoding, *mesh);
  voyager_.create_composite(passes_.overlay(), colour_format, kDepthFormat);

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
Renderer::~Renderer() {
  vkDeviceWaitIdle(device_.get());
}

void Renderer::resize(VkExtent2D extent) {
  device_.wait_idle();
  targets_ = {};
  targets_ = RenderTargets(device_, passes_, colour_format_, extent);
  voyager_.resize(extent);
}

uint32_t Renderer::wait_for_slot() {
  wait_for(device_.get(), slots_[slot_].after_done.get());
  return slot_;
}

void Renderer::draw(const Camera& camera, const Look& look, const Delivery& delivery) {
  wait_for_slot();
  const Slot& slot = slots_[slot_];
  const bool splats = look.composite != Composite::none;
  if (splats) voyager_.begin_frame();
  record_before(slot, camera, look);
  submit_before(slot, splats);
  if (splats) voyager_.render(camera, slot_, look.composite == Composite::limit && look.mesh);
  record_after(slot, look, delivery);
  submit_after(slot, splats, delivery);
  slot_ = (slot_ + 1) % kFramesInFlight;
}

void Renderer::record_meshes(VkCommandBuffer commands, const Camera& camera, bool mesh) const {
  begin_pass(commands, passes_.meshes(), targets_.meshes.get(), targets_.extent, depth_);
  if (mesh && meshes_)
    meshes_->record(commands, targets_.extent,
                    glm::mat4(clip_from_view(camera.frustum, depth_) *
                              view_from_world(camera.pose) * mesh_place_));
  vkCmdEndRenderPass(commands);
}

void Renderer::record_before(const Slot& slot, const Camera& camera, const Look& look) {
  begin(slot.before);
  record_meshes(slot.before, camera, look.mesh);
  if (look.composite == Composite::limit && look.mesh)
    voyager_.record_depth_limit(slot.before, slot_, {targets_.depth.image.get(), kDepthFormat});
  if (look.composite != Composite::none) voyager_.record_release(slot.before, slot_);
  end(slot.before);
}

void Renderer::submit_before(const Slot& slot, bool splats) {
  Submission submission(slot.before);
  if (splats) submission.signal(voyager_.released(slot_));
  if (!splats || !voyager_.host_waits()) {
    submission.submit(device_.queue(), VK_NULL_HANDLE);
    return;
  }
  const VkFence fence = slot.before_done.get();
  submission.submit(device_.queue(), fence);
  wait_for(device_.get(), fence);
  check(vkResetFences(device_.get(), 1, &fence), "vkResetFences");
}

void Renderer::record_after(const Slot& slot, const Look& look, const Delivery& delivery) {
  begin(slot.after);
  const bool splats = look.composite != Composite::none;
  if (splats) voyager_.record_acquire(slot.after, slot_);
  begin_pass(slot.after, passes_.overlay(), targets_.overlay.get(), targets_.extent, depth_);
  if (splats)
    voyager_.record_composite(
        slot.after, slot_,
        look.composite == Composite::test ? VOY_VULKAN_DEPTH_USE_TEST : VOY_VULKAN_DEPTH_USE_WRITE);
  if (delivery.overlay) delivery.overlay(slot.after);
  vkCmdEndRenderPass(slot.after);
  delivery.record(slot.after, targets_);
  end(slot.after);
}

void Renderer::submit_after(const Slot& slot, bool splats, const Delivery& delivery) {
  Submission submission(slot.after);
  if (splats) submission.wait(voyager_.rendered(slot_), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
  submission.wait({delivery.wait}, VK_PIPELINE_STAGE_TRANSFER_BIT);
  submission.signal({delivery.signal});
  const VkFence fence = slot.after_done.get();
  check(vkResetFences(device_.get(), 1, &fence), "vkResetFences");
  submission.submit(device_.queue(), fence);
}

}  // namespace host
