#pragma once
// GLFW's window, and what a player does with mouse and keys in it.
#define GLFW_INCLUDE_NONE
#include <vulkan/vulkan.h>
// After Vulkan, so that it declares what it does with it.
#include <GLFW/glfw3.h>

#include <glm/vec2.hpp>
#include <string>
#include <vector>

#include "instance.h"

namespace host {

// Before the instance: it knows which extensions a surface needs.
class Glfw {
 public:
  // Whether a window could be opened now. Not while there is a Glfw.
  static bool has_display();
  // no_display: what to say where there is none.
  explicit Glfw(const std::string& no_display);
  ~Glfw() { glfwTerminate(); }
  Glfw(const Glfw&) = delete;
  Glfw& operator=(const Glfw&) = delete;

  Presentation presentation() const;
};

class Window {
 public:
  Window(VkInstance instance, const char* title, int width, int height);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* get() const { return window_; }
  VkSurfaceKHR surface() const { return surface_; }
  bool closed() const { return glfwWindowShouldClose(window_) != 0; }
  VkExtent2D extent() const;  // pixels; 0 while minimised
  // How long the primary display shows a frame.
  double frame_milliseconds() const;

  bool pressed(int key) const { return glfwGetKey(window_, key) == GLFW_PRESS; }
  bool button(int button) const { return glfwGetMouseButton(window_, button) == GLFW_PRESS; }
  // 1 while the first key is down, -1 while the second is, 0 for neither or both.
  double axis(int positive, int negative) const {
    return int{pressed(positive)} - int{pressed(negative)};
  }
  // Keys that went down since the last call, also those that are up again.
  std::vector<int> take_keys();
  // Where the cursor is: shares of the width and the height, 0 to 1 inside.
  glm::dvec2 cursor() const;
  // Since the last call: pixels, to the right and down; steps of the wheel, upwards.
  glm::dvec2 take_cursor_move();
  double take_wheel();
  // The files that were dropped on the window since the last call.
  std::vector<std::string> take_dropped();

 private:
  VkInstance instance_;
  GLFWwindow* window_ = nullptr;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  glm::dvec2 cursor_ = {};
  double wheel_ = 0;
  std::vector<int> keys_;
  std::vector<std::string> dropped_;
};

}  // namespace host
