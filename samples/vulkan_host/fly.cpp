#include "fly.h"

#include <cmath>

namespace host {

void fly(Window& window, FlyCamera& camera, double seconds, bool ui_has_mouse,
         bool ui_has_keyboard) {
  constexpr double kRadiansAPixel = 0.004;
  const glm::dvec2 moved = window.take_cursor_move();
  if (!ui_has_mouse && window.button(GLFW_MOUSE_BUTTON_RIGHT)) camera.turn(moved * -kRadiansAPixel);
  const double wheel = window.take_wheel();
  if (!ui_has_mouse) camera.change_speed(std::pow(1.2, wheel));
  if (ui_has_keyboard) return;
  const double faster = window.pressed(GLFW_KEY_LEFT_SHIFT) ? 5 : 1;
  camera.move({window.axis(GLFW_KEY_D, GLFW_KEY_A), window.axis(GLFW_KEY_E, GLFW_KEY_Q),
               window.axis(GLFW_KEY_S, GLFW_KEY_W)},
              seconds * faster);
}

}  // namespace host
