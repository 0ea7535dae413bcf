#pragma once
// What a frame took, and what can be turned: Dear ImGui, in the overlay's render pass.
#include "fly_camera.h"
#include "gui.h"
#include "renderer.h"

namespace host {

// What the HUD turns.
struct HudState {
  Look look;
  float tau;              // where time is held, what Voyager chose
  bool holds_time;        // tau follows frame_time
  float frame_time = 12;  // milliseconds a frame of Voyager's
};

class Hud {
 public:
  Hud(const Device& device, const Window& window, VkRenderPass pass)
      : gui_(device, &window, pass) {}

  bool has_mouse() const { return gui_.has_mouse(); }
  bool has_keyboard() const { return gui_.has_keyboard(); }
  // stats: NULL before the first frame and where no splats are drawn.
  void build(HudState& state, const Device& device, const VoyagerLayer& voyager,
             const VoyFrameStats* stats, const FlyCamera& camera);
  void record(VkCommandBuffer commands) const { gui_.record(commands); }

 private:
  Gui gui_;
};

}  // namespace host
