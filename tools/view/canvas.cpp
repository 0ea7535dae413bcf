#include "tools/view/canvas.h"

#include <chrono>
#include <thread>

namespace voyager::view {

Canvas::Canvas(const host::Instance& instance, const host::Device& device, VkExtent2D size,
               bool in_window)
    : size_(size) {
  if (!in_window) return;
  window_.emplace(instance.get(), "Voyager", static_cast<int>(size.width),
                  static_cast<int>(size.height));
  swapchain_.emplace(device, window_->surface());
}

VkFormat Canvas::colour_format() const {
  return swapchain_ ? swapchain_->colour_format() : VK_FORMAT_R8G8B8A8_UNORM;
}

void Canvas::set_title(const std::string& title) {
  if (window_) glfwSetWindowTitle(window_->get(), title.c_str());
}

void Canvas::take_events() {
  if (window_) glfwPollEvents();
}

void Canvas::wait_for_events(double seconds) {
  if (window_)
    glfwWaitEventsTimeout(seconds);
  else
    std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

void Canvas::set_size(VkExtent2D size) {
  size_ = size;
  if (window_)
    glfwSetWindowSize(window_->get(), static_cast<int>(size.width), static_cast<int>(size.height));
}

VkExtent2D Canvas::wanted() const {
  return window_ ? window_->extent() : size_;
}

bool Canvas::resize(VkExtent2D wanted) {
  return !swapchain_ || swapchain_->resize(wanted);
}

bool Canvas::acquire(uint32_t slot) {
  return !swapchain_ || swapchain_->acquire(slot);
}

VkSemaphore Canvas::acquired(uint32_t slot) const {
  return swapchain_ ? swapchain_->acquired(slot) : VK_NULL_HANDLE;
}

VkSemaphore Canvas::ready() const {
  return swapchain_ ? swapchain_->ready() : VK_NULL_HANDLE;
}

void Canvas::record(VkCommandBuffer commands, const host::RenderTargets& targets) const {
  if (swapchain_) swapchain_->record(commands, targets);
}

bool Canvas::present() {
  return !swapchain_ || swapchain_->present();
}

}  // namespace voyager::view
