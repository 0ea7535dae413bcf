#include "tools/view/frame_renderer.h"

#include "render_pass.h"

namespace voyager::view {
namespace {

constexpr VkClearColorValue kNoScene = {{0.08f, 0.08f, 0.09f, 1}};

}  // namespace

FrameRenderer::FrameRenderer(const host::Device& device, VkFormat colour)
    : device_(device),
      colour_(colour),
      passes_(device, colour),
      screen_(device, passes_.meshes(), colour),
      frames_(device) {}

void FrameRenderer::resize(VkExtent2D extent) {
  device_.wait_idle();
  targets_ = {};
  targets_ = host::RenderTargets(device_, passes_, colour_, extent);
}

void FrameRenderer::draw(const FrameDesc& frame) {
  const uint32_t slot = wait_for_slot();
  std::vector<SplatView*> drawn;
  for (SplatView* view : {frame.left, frame.right})
    if (view && frame.draw) drawn.push_back(view);
  if (!drawn.empty()) render(frame, drawn);
  host::Submission submission(record_after(slot, frame, drawn));
  for (const SplatView* view : drawn)
    submission.wait(view->rendered(), VK_PIPELINE_STAGE_ALL_COMMANDS_BIT);
  submission.wait({frame.acquired}, VK_PIPELINE_STAGE_TRANSFER_BIT);
  submission.signal({frame.ready});
  frames_.submit_after(submission);
}

void FrameRenderer::render(const FrameDesc& frame, const std::vector<SplatView*>& views) {
  const VkCommandBuffer commands = frames_.begin_before();
  host::Submission submission(commands);
  for (SplatView* view : views) {
    view->release(commands);
    submission.signal(view->released());
  }
  frames_.submit_before(submission, views.front()->host_waits());
  for (SplatView* view : views) view->render(frame.camera, frame.background, frame.wait);
}

VkCommandBuffer FrameRenderer::record_after(uint32_t slot, const FrameDesc& frame,
                                            const std::vector<SplatView*>& drawn) {
  const VkCommandBuffer commands = frames_.begin_after();
  for (const SplatView* view : drawn) view->acquire(commands);
  host::begin_pass(commands, passes_.meshes(), targets_.meshes.get(), targets_.extent, kNoScene, 0);
  if (frame.left) record_screen(commands, slot, frame);
  vkCmdEndRenderPass(commands);
  host::begin_pass(commands, passes_.overlay(), targets_.overlay.get(), targets_.extent, kNoScene,
                   0);
  if (frame.overlay) frame.overlay(commands);
  vkCmdEndRenderPass(commands);
  frame.record(commands, targets_);
  return commands;
}

void FrameRenderer::record_screen(VkCommandBuffer commands, uint32_t slot, const FrameDesc& frame) {
  Screen screen;
  screen.left = screen.right = frame.left->picture();
  screen.exposure = frame.exposure;
  screen.split = static_cast<float>(targets_.extent.width) + 2;  // nowhere
  if (frame.right) screen.right = frame.right->picture();
  if (frame.still) screen.right = frame.still;
  if (frame.right || frame.still) screen.split = frame.split;
  screen_.record(commands, slot, targets_.extent, screen);
}

}  // namespace voyager::view
