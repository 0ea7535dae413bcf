#include "window_loop.h"

#include <optional>

#include "fly.h"
#include "placement.h"

namespace host {
namespace {

// Either tau is what the player turns it to, or it follows the time that frames may take.
void set_detail(VoyagerLayer& voyager, HudState& state, const VoyFrameStats* last) {
  if (!state.holds_time) return voyager.set_tau(double{state.tau});
  voyager.hold_frame_time(double{state.frame_time});
  if (last) state.tau = static_cast<float>(last->tau);
}

// Steps through the camera file with the key C.
class Bookmarks {
 public:
  explicit Bookmarks(const std::vector<Camera>& cameras) : cameras_(cameras) {}
  void update(Window& window, FlyCamera& camera) {
    for (const int key : window.take_keys())
      if (key == GLFW_KEY_C && !cameras_.empty())
        camera.look_from(cameras_[++index_ % cameras_.size()].pose);
  }

 private:
  const std::vector<Camera>& cameras_;
  size_t index_ = 0;
};

}  // namespace

void run_window(const Device& device, Window& window, Swapchain& swapchain, Renderer& renderer,
                VoyagerLayer& voyager, const std::vector<Camera>& cameras,
                const WindowOptions& options, FrameLog& log) {
  Hud hud(device, window, renderer.overlay_pass());
  HudState state = options.hud;
  const VoySceneInfo scene = voyager.scene();
  FlyCamera camera(cameras.empty() ? overview(scene) : cameras.front().pose,
                   0.05 * diagonal(scene));
  Bookmarks bookmarks(cameras);
  std::optional<VoyFrameStats> stats;
  bool current = false;
  VkExtent2D asked = {0, 0};  // the surface may have given another
  double last = glfwGetTime();
  for (uint64_t frame = 0; !window.closed() && (options.frames == 0 || frame < options.frames);) {
    glfwPollEvents();
    const VkExtent2D wanted = window.extent();
    if (!current || wanted.width != asked.width || wanted.height != asked.height) {
      device.wait_idle();
      asked = wanted;
      if (!swapchain.resize(wanted)) {
        glfwWaitEventsTimeout(0.1);  // minimised
        continue;
      }
      renderer.resize(swapchain.extent());
    }
    const uint32_t slot = renderer.wait_for_slot();
    if (!(current = swapchain.acquire(slot))) continue;

    const double now = glfwGetTime();
    fly(window, camera, now - last, hud.has_mouse(), hud.has_keyboard());
    bookmarks.update(window, camera);
    last = now;
    set_detail(voyager, state, stats ? &*stats : nullptr);
    hud.build(state, device, voyager, stats ? &*stats : nullptr, camera);

    Delivery delivery;
    delivery.overlay = [&](VkCommandBuffer commands) { hud.record(commands); };
    delivery.record = [&](VkCommandBuffer commands, const RenderTargets& targets) {
      swapchain.record(commands, targets);
    };
    delivery.wait = swapchain.acquired(slot);
    delivery.signal = swapchain.ready();
    renderer.draw(camera.camera(swapchain.extent().width, swapchain.extent().height), state.look,
                  delivery);
    current = swapchain.present();
    const bool splats = state.look.composite != Composite::none;
    stats.reset();
    if (splats) stats = voyager.stats();
    log.add(splats ? &voyager : nullptr);
    ++frame;
  }
  device.wait_idle();
}

}  // namespace host
