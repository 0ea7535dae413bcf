#include "window.h"

#include <cmath>
#include <string>

#include "failure.h"

namespace host {
namespace {

[[noreturn]] void fail(const char* call) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  throw Failure(kMachine, std::string(call) + ": " + (reason ? reason : "failed"));
}

}  // namespace

Glfw::Glfw() {
  if (!glfwInit()) fail("no window (--offscreen needs none): glfwInit");
  if (!glfwVulkanSupported()) {
    glfwTerminate();
    throw Failure(kMachine, "found no Vulkan that presents to a window, expected one");
  }
}

Presentation Glfw::presentation() const {
  Presentation presentation;
  uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  presentation.instance_extensions.assign(names, names + count);
  presentation.supports = [](VkInstance instance, VkPhysicalDevice physical, uint32_t family) {
    return glfwGetPhysicalDevicePresentationSupport(instance, physical, family) == GLFW_TRUE;
  };
  return presentation;
}

Window::Window(VkInstance instance, const char* title, int width, int height)
    : instance_(instance) {
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  window_ = glfwCreateWindow(width, height, title, nullptr, nullptr);
  if (!window_) fail("glfwCreateWindow");
  if (glfwCreateWindowSurface(instance, window_, nullptr, &surface_) != VK_SUCCESS) {
    glfwDestroyWindow(window_);
    fail("glfwCreateWindowSurface");
  }
  // The HUD's callbacks, which come later, call this one on.
  glfwSetWindowUserPointer(window_, this);
  glfwSetScrollCallback(window_, [](GLFWwindow* window, double, double y) {
    static_cast<Window*>(glfwGetWindowUserPointer(window))->wheel_ += y;
  });
}

Window::~Window() {
  vkDestroySurfaceKHR(instance_, surface_, nullptr);
  glfwDestroyWindow(window_);
}

VkExtent2D Window::extent() const {
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  return {static_cast<uint32_t>(width), static_cast<uint32_t>(height)};
}

double Window::key(int positive, int negative) const {
  return (glfwGetKey(window_, positive) == GLFW_PRESS) -
         (glfwGetKey(window_, negative) == GLFW_PRESS);
}

void Window::fly(FlyCamera& camera, double seconds, bool ui_has_mouse, bool ui_has_keyboard) {
  constexpr double kRadiansAPixel = 0.004;
  glm::dvec2 cursor;
  glfwGetCursorPos(window_, &cursor.x, &cursor.y);
  if (!ui_has_mouse && glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS)
    camera.turn((cursor_ - cursor) * kRadiansAPixel);
  cursor_ = cursor;
  if (!ui_has_mouse) camera.change_speed(std::pow(1.2, wheel_));
  wheel_ = 0;
  if (ui_has_keyboard) return;
  const double faster = glfwGetKey(window_, GLFW_KEY_LEFT_SHIFT) == GLFW_PRESS ? 5 : 1;
  camera.move(
      {key(GLFW_KEY_D, GLFW_KEY_A), key(GLFW_KEY_E, GLFW_KEY_Q), key(GLFW_KEY_S, GLFW_KEY_W)},
      seconds * faster);
}

}  // namespace host
