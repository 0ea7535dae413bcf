#pragma once
#include "tools/view/navigator.h"
#include "window.h"

namespace voyager::view {

// Mouse, held keys and gamepad since the last call move the camera (docs/viewer.md lists them).
// panel_has_*: the panel has the mouse or the keyboard.
void steer(host::Window& window, Navigator& navigator, double seconds, bool panel_has_mouse,
           bool panel_has_keyboard);

}  // namespace voyager::view
