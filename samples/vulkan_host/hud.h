#pragma once
// What a frame took, and what can be turned: Dear ImGui, in the overlay's render pass.
#include "fly_camera.h"
#include "gui.h"
#include "renderer.h"

namespace host {

// What the HUD turns.
struct HudState {
  Look look;
  float tau;
  bool steer_tau = false;       // towards time_budget
  float time_budget = 16;       // milliseconds a frame of Voyager's
  double budget_megabytes = 0;  // of scene data, given at the start; 0: no limit
};

class Hud {
 public:
  Hud(const Device& device, const Window& window, VkRenderPass pass) : gui_(device, window, pass) {}

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
