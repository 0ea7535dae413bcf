#pragma once
// GLFW's window, and what a player does in it.
#define GLFW_INCLUDE_NONE
#include <vulkan/vulkan.h>
// After Vulkan, so that it declares what it does with it.
#include <GLFW/glfw3.h>

#include "fly_camera.h"
#include "instance.h"

namespace host {

// Before the instance: it knows which extensions a surface needs.
class Glfw {
 public:
  Glfw();
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

  // W A S D, Q and E: along the camera's axes; Shift: faster; right button: turn; wheel: speed.
  // ui_has_*: the HUD has the mouse or the keyboard.
  void fly(FlyCamera& camera, double seconds, bool ui_has_mouse, bool ui_has_keyboard);

 private:
  double key(int positive, int negative) const;

  VkInstance instance_;
  GLFWwindow* window_ = nullptr;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  glm::dvec2 cursor_ = {};
  double wheel_ = 0;
};

}  // namespace host
