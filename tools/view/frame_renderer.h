#pragma once
// A frame of the window: Voyager draws one view or two, they are shown on either side of a line,
// and the panel over them. Two frames are in flight.
#include <functional>
#include <vector>

#include "frame_commands.h"
#include "render_targets.h"
#include "tools/view/screen_pipeline.h"
#include "tools/view/splat_view.h"

namespace voyager::view {

struct FrameDesc {
  host::Camera camera = {};                      // of the renderer's size
  SplatView* left = nullptr;                     // NULL: no scene
  SplatView* right = nullptr;                    // NULL: none
  VkImageView still = VK_NULL_HANDLE;            // a picture in place of the right view
  float split = 0, exposure = 1;                 // as Screen
  const float* background = nullptr;             // three code values
  bool draw = true;                              // false: what Voyager drew last is shown again
  bool wait = false;                             // for all that the frame needs of a streamed scene
  std::function<void(VkCommandBuffer)> overlay;  // in the render pass, or empty
  // After it: the picture is in TRANSFER_SRC_OPTIMAL.
  std::function<void(VkCommandBuffer, const host::RenderTargets&)> record;
  VkSemaphore acquired = VK_NULL_HANDLE, ready = VK_NULL_HANDLE;  // binary, at the transfers
};

class FrameRenderer {
 public:
  FrameRenderer(const host::Device& device, VkFormat colour);

  VkRenderPass overlay_pass() const { return passes_.overlay(); }
  VkExtent2D extent() const { return targets_.extent; }
  // Waits until the queue is idle.
  void resize(VkExtent2D extent);
  // The slot of the next frame, once the frame before it there is done.
  uint32_t wait_for_slot() const { return frames_.wait_for_slot(); }
  // Where Voyager refuses the frame, nothing is shown, and the same can be drawn without a scene.
  void draw(const FrameDesc& frame);

 private:
  void render(const FrameDesc& frame, const std::vector<SplatView*>& views);
  VkCommandBuffer record_after(uint32_t slot, const FrameDesc& frame,
                               const std::vector<SplatView*>& drawn);
  void record_screen(VkCommandBuffer commands, uint32_t slot, const FrameDesc& frame);

  const host::Device& device_;
  const VkFormat colour_;
  host::RenderPasses passes_;
  ScreenPipeline screen_;
  host::RenderTargets targets_;
  host::FrameCommands frames_;
};

}  // namespace voyager::view
