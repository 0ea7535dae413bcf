#pragma once
// Frames without a window: a PNG each, numbered from 0000.
#include <string>

#include "camera_file.h"
#include "frame_log.h"
#include "renderer.h"

namespace host {

struct OffscreenOptions {
  std::string folder;
  uint64_t frames;  // cameras are repeated from the start
  bool write_depth;
};

// Throws Failure(kMachine) where no picture could be written there.
void make_folder(const std::string& folder);
// Into a folder that is there.
void run_offscreen(const Device& device, Renderer& renderer, VoyagerLayer& voyager,
                   const DepthConvention& depth, const std::vector<Camera>& cameras,
                   const Look& look, const OffscreenOptions& options, FrameLog& log);

}  // namespace host
