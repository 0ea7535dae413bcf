#pragma once
// What a camera path asks of a view, frame by frame.
#include <vector>

#include "runtime/frame/backend.h"
#include "tools/cameras.h"

namespace voyager::tools {

// A frame as voyRenderFrame would have it: black background, near plane 0.2 m, no depth.
// Throws Error(refused_input) for a camera without a frustum.
FrameInput frame_input(const Camera& camera, double tau);

// A frame a camera.
std::vector<FrameInput> frame_path(const std::vector<Camera>& cameras, double tau);

// A frame of two eyes for each pair of cameras.
std::vector<FrameInput> stereo_path(const std::vector<Camera>& cameras, double tau);

// At most `most` indices below `count`, evenly spread, first and last among them.
std::vector<size_t> spread_indices(size_t count, size_t most);

}  // namespace voyager::tools
