#pragma once
// Dear ImGui in a window, drawn in a render pass of the host.
#include "device.h"
#include "unique.h"
#include "window.h"

namespace host {

class Gui {
 public:
  // Call it after the window's own callbacks are set: it calls them on.
  Gui(const Device& device, const Window& window, VkRenderPass pass);
  ~Gui();
  Gui(const Gui&) = delete;
  Gui& operator=(const Gui&) = delete;

  bool has_mouse() const;
  bool has_keyboard() const;
  // Between the two calls the host describes what is shown.
  void begin();
  void end();
  // In the render pass.
  void record(VkCommandBuffer commands) const;

 private:
  UniqueDescriptorPool pool_;
};

}  // namespace host
