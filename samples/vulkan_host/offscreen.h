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

// Makes the folder. Throws Failure(kMachine) where one of the pictures could not be written there,
// Failure(kBadUsage) where one is any of the other files.
void prepare_folder(const OffscreenOptions& options, const std::vector<std::string>& others);
// Into a folder that is there.
void run_offscreen(const Device& device, Renderer& renderer, VoyagerLayer& voyager,
                   const DepthConvention& depth, const std::vector<Camera>& cameras,
                   const Look& look, const OffscreenOptions& options, FrameLog& log);

}  // namespace host
