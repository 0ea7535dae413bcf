#pragma once
// Where the viewer's frames go: into a window, or, where nobody looks, nowhere but into the
// pictures that are taken of them.
#include <optional>
#include <string>

#include "swapchain.h"
#include "window.h"

namespace voyager::view {

class Canvas {
 public:
  // size: pixels. Both must outlive it.
  Canvas(const host::Instance& instance, const host::Device& device, VkExtent2D size,
         bool in_window);

  host::Window* window() { return window_ ? &*window_ : nullptr; }  // NULL: off screen
  VkFormat colour_format() const;
  bool closed() const { return window_ && window_->closed(); }
  void set_title(const std::string& title);
  // Input; waits for it, or for so long.
  void take_events();
  void wait_for_events(double seconds);

  // Of the next frames.
  void set_size(VkExtent2D size);
  VkExtent2D wanted() const;
  // The queue must be idle. False: the window has no size now.
  bool resize(VkExtent2D wanted);
  VkExtent2D extent() const { return swapchain_ ? swapchain_->extent() : size_; }

  // A frame. False: the window has changed, resize.
  bool acquire(uint32_t slot);
  VkSemaphore acquired(uint32_t slot) const;  // NULL: nothing to wait for
  VkSemaphore ready() const;                  // NULL: nobody waits
  void record(VkCommandBuffer commands, const host::RenderTargets& targets) const;
  bool present();

 private:
  std::optional<host::Window> window_;
  std::optional<host::Swapchain> swapchain_;
  VkExtent2D size_;  // off screen
};

}  // namespace voyager::view
