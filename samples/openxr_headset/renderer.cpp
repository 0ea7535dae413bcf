#include "renderer.h"

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

const VoyagerLayer& sized(VoyagerLayer& voyager, const EyeImages& images) {
  voyager.resize(images.extents(), images.depth_format().has_value());
  return voyager;
}

}  // namespace

Renderer::Renderer(const Graphics& graphics, VoyagerLayer& voyager, const EyeImages& images,
                   const DepthConvention& convention, Recorder* recorder)
    : graphics_(graphics),
      voyager_(voyager),
      images_(images),
      convention_(convention),
      recorder_(recorder),
      pass_(graphics, images.colour_format().format, images.depth_format(), sized(voyager, images),
            convention),
      areas_{VisibleArea(graphics), VisibleArea(graphics)} {
  const VkCommandPoolCreateInfo pool_info = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                             VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT,
                                             graphics.queue_family()};
  VkCommandPool pool = VK_NULL_HANDLE;
  check(vkCreateCommandPool(graphics.get(), &pool_info, nullptr, &pool), "vkCreateCommandPool");
  pool_ = {graphics.get(), pool};
  const VkCommandBufferAllocateInfo info = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr,
                                            pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  for (Slot& slot : slots_) {
    for (VkCommandBuffer* commands : {&slot.before, &slot.after})
      check(vkAllocateCommandBuffers(graphics.get(), &info, commands), "vkAllocateCommandBuffers");
    slot.before_done = make_fence(graphics.get(), 0);
    slot.after_done = make_fence(graphics.get(), VK_FENCE_CREATE_SIGNALED_BIT);
    if (recorder) slot.readback.emplace(graphics, images);
  }
}

// Frames may be in flight where a loss or an error ends the session.
Renderer::~Renderer() {
  vkDeviceWaitIdle(graphics_.get());
}

void Renderer::set_visible_area(size_t eye, VisibleArea area) {
  graphics_.wait_idle();
  areas_[eye] = std::move(area);
}

void Renderer::draw(const std::array<Camera, kEyes>& eyes, uint64_t frame) {
  Slot& slot = slots_[slot_];
  wait_for(graphics_.get(), slot.after_done.get());
  save(slot);
  voyager_.begin_frame();
  submit_before(slot);
  voyager_.render(eyes, convention_.near_z, slot_);
  record_after(slot, eyes);
  submit_after(slot);
  if (recorder_) {
    recorder_->add(frame, eyes);
    slot.recorded = frame;
  }
  slot_ = (slot_ + 1) % kFramesInFlight;
}

void Renderer::save(Slot& slot) {
  if (!slot.recorded) return;
  for (size_t eye = 0; eye < kEyes; ++eye)
    recorder_->write_picture(*slot.recorded, eye, slot.readback->extent(eye),
                             slot.readback->rgba(eye));
  slot.recorded.reset();
}

void Renderer::finish() {
  graphics_.wait_idle();
  for (Slot& slot : slots_) save(slot);
}

void Renderer::submit_before(const Slot& slot) {
  begin(slot.before);
  voyager_.record_release(slot.before, slot_);
  end(slot.before);
  Submission submission(slot.before);
  voyager_.signal_released(submission, slot_);
  if (!voyager_.host_waits()) {
    submission.submit(graphics_.queue(), VK_NULL_HANDLE);
    return;
  }
  const VkFence fence = slot.before_done.get();
  submission.submit(graphics_.queue(), fence);
  wait_for(graphics_.get(), fence);
  check(vkResetFences(graphics_.get(), 1, &fence), "vkResetFences");
}

void Renderer::record_after(const Slot& slot, const std::array<Camera, kEyes>& eyes) {
  begin(slot.after);
  voyager_.record_acquire(slot.after, slot_);
  for (size_t eye = 0; eye < kEyes; ++eye)
    pass_.record(slot.after, slot_, eye, images_.eye(eye), areas_[eye], eyes[eye].frustum);
  if (slot.readback) slot.readback->record(slot.after, images_);
  end(slot.after);
}

void Renderer::submit_after(const Slot& slot) {
  Submission submission(slot.after);
  voyager_.wait_for_rendered(submission, slot_);
  const VkFence fence = slot.after_done.get();
  check(vkResetFences(graphics_.get(), 1, &fence), "vkResetFences");
  submission.submit(graphics_.queue(), fence);
}

}  // namespace host
