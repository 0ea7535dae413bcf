#pragma once
// Frames in a window, until it is closed.
#include "camera_file.h"
#include "frame_log.h"
#include "hud.h"
#include "swapchain.h"

namespace host {

struct WindowOptions {
  uint64_t frames;  // 0: no end
  HudState hud;
};

void run_window(const Device& device, Window& window, Swapchain& swapchain, Renderer& renderer,
                VoyagerLayer& voyager, const std::vector<Camera>& cameras,
                const WindowOptions& options, FrameLog& log);

}  // namespace host
