#pragma once
// Dear ImGui in a window or off screen, drawn in a render pass of the host.
#include <chrono>

#include "device.h"
#include "unique.h"
#include "window.h"

namespace host {

class Gui {
 public:
  // Call it after the window's own callbacks are set: it calls them on. NULL: off screen, where
  // nobody has a mouse or a keyboard.
  Gui(const Device& device, const Window* window, VkRenderPass pass);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  bool has_mouse() const;
  bool has_keyboard() const;
  // Off screen, before the first frame: pixels. A window knows its own size.
  void resize(VkExtent2D extent);
  // Between the two calls the host describes what is shown.
  void begin();
  void end();
  // In the render pass.
  void record(VkCommandBuffer commands) const;

 private:
  void step_clock();

  const bool in_window_;
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
  UniqueDescriptorPool pool_;
};

}  // namespace host
