#pragma once
// How mouse and keys fly the camera.
#include "fly_camera.h"
#include "window.h"

namespace host {

// W A S D, Q and E: along the camera's axes; Shift: faster; right button: turn; wheel: speed.
// ui_has_*: the HUD has the mouse or the keyboard.
void fly(Window& window, FlyCamera& camera, double seconds, bool ui_has_mouse,
         bool ui_has_keyboard);

}  // namespace host
