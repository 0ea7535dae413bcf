#pragma once
// Paths on which the picture hardly moves: what changes there beyond the truth shimmers.
#include <vector>

#include "runtime/frame/backend.h"
#include "runtime/frame/scene.h"

namespace voyager::tools {

struct SlowPaths {
  // Forward: at half the picture's width, and the median distance of the leaves that are in the
  // picture, by a quarter of a pixel a frame. Empty where there are none in it.
  std::vector<FrameInput> dolly;
  // To the right, by a quarter of a pixel in the middle of the picture a frame.
  std::vector<FrameInput> turn;
};

// Of so many frames each, from that one on. scene: loaded whole, without instances.
SlowPaths slow_paths(const FrameInput& first, const Scene& scene, size_t frames);

}  // namespace voyager::tools
