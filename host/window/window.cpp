#include "window.h"

#include <algorithm>
#include <utility>

#include "failure.h"

namespace host {
namespace {

[[noreturn]] void fail(const char* call) {
  const char* reason = nullptr;
  glfwGetError(&reason);
  throw Failure(kMachine, std::string(call) + ": " + (reason ? reason : "failed"));
}

}  // namespace

bool Glfw::has_display() {
  const bool found = glfwInit() == GLFW_TRUE;
  glfwTerminate();
  return found;
}

Glfw::Glfw(const std::string& no_display) {
  if (!glfwInit()) fail((no_display + ": glfwInit").c_str());
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
  glfwSetKeyCallback(window_, [](GLFWwindow* window, int key, int, int action, int) {
    if (action == GLFW_PRESS)
      static_cast<Window*>(glfwGetWindowUserPointer(window))->keys_.push_back(key);
  });
  glfwSetDropCallback(window_, [](GLFWwindow* window, int count, const char** paths) {
    auto& dropped = static_cast<Window*>(glfwGetWindowUserPointer(window))->dropped_;
    dropped.insert(dropped.end(), paths, paths + count);
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

double Window::frame_milliseconds() const {
  constexpr int kUsual = 60;  // where the display does not say
  GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* const mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  return 1000.0 / (mode && mode->refreshRate > 0 ? mode->refreshRate : kUsual);
}

std::vector<int> Window::take_keys() {
  return std::exchange(keys_, {});
}

glm::dvec2 Window::cursor() const {
  glm::dvec2 cursor;
  glfwGetCursorPos(window_, &cursor.x, &cursor.y);
  int width = 1, height = 1;
  glfwGetWindowSize(window_, &width, &height);
  return cursor / glm::dvec2(std::max(width, 1), std::max(height, 1));
}

glm::dvec2 Window::take_cursor_move() {
  glm::dvec2 cursor;
  glfwGetCursorPos(window_, &cursor.x, &cursor.y);
  return cursor - std::exchange(cursor_, cursor);
}

std::vector<std::string> Window::take_dropped() {
  return std::exchange(dropped_, {});
}

double Window::take_wheel() {
  return std::exchange(wheel_, 0);
}

}  // namespace host
