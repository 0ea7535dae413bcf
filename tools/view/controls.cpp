#include "tools/view/controls.h"

#include <cmath>

namespace voyager::view {
namespace {

constexpr double kRadiansAPixel = 0.004, kRadiansASecond = 1.6;  // of mouse and stick
constexpr float kRest = 0.15f;  // how far a stick at rest may be off its middle

void steer_by_mouse(host::Window& window, Navigator& navigator, bool taken) {
  const glm::dvec2 moved = window.take_cursor_move() * kRadiansAPixel;
  const double wheel = window.take_wheel();
  if (taken) return;
  if (window.button(GLFW_MOUSE_BUTTON_MIDDLE))
    navigator.pan({-moved.x, moved.y});
  else if (window.button(GLFW_MOUSE_BUTTON_LEFT) || window.button(GLFW_MOUSE_BUTTON_RIGHT))
    navigator.turn(-moved);
  if (wheel != 0) navigator.zoom(wheel);
}

void steer_by_keys(const host::Window& window, Navigator& navigator, double seconds) {
  const double faster = window.pressed(GLFW_KEY_LEFT_SHIFT) ? 5 : 1;
  navigator.move({window.axis(GLFW_KEY_D, GLFW_KEY_A), window.axis(GLFW_KEY_E, GLFW_KEY_Q),
                  window.axis(GLFW_KEY_S, GLFW_KEY_W)},
                 seconds * faster);
  navigator.turn(seconds * kRadiansASecond *
                 glm::dvec2(window.axis(GLFW_KEY_LEFT, GLFW_KEY_RIGHT),
                            window.axis(GLFW_KEY_UP, GLFW_KEY_DOWN)));
}

double stick(float value) {
  return std::abs(value) < kRest ? 0 : double{value};
}

// Left stick: move; right stick: turn; triggers: down and up; bumpers: slower and faster.
void steer_by_gamepad(Navigator& navigator, double seconds) {
  GLFWgamepadstate pad;
  if (!glfwGetGamepadState(GLFW_JOYSTICK_1, &pad)) return;
  const float* axes = pad.axes;
  const auto trigger = [&](int axis) { return double{axes[axis]} / 2 + 0.5; };
  const double up =
      trigger(GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER) - trigger(GLFW_GAMEPAD_AXIS_LEFT_TRIGGER);
  navigator.move({stick(axes[GLFW_GAMEPAD_AXIS_LEFT_X]), up, stick(axes[GLFW_GAMEPAD_AXIS_LEFT_Y])},
                 seconds);
  navigator.turn(
      -seconds * kRadiansASecond *
      glm::dvec2(stick(axes[GLFW_GAMEPAD_AXIS_RIGHT_X]), stick(axes[GLFW_GAMEPAD_AXIS_RIGHT_Y])));
  const int faster =
      pad.buttons[GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER] - pad.buttons[GLFW_GAMEPAD_BUTTON_LEFT_BUMPER];
  navigator.set_speed(navigator.speed() * std::pow(4.0, faster * seconds));
}

}  // namespace

void steer(host::Window& window, Navigator& navigator, double seconds, bool panel_has_mouse,
           bool panel_has_keyboard) {
  steer_by_mouse(window, navigator, panel_has_mouse);
  if (!panel_has_keyboard) steer_by_keys(window, navigator, seconds);
  steer_by_gamepad(navigator, seconds);
}

}  // namespace voyager::view
