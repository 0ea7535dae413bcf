#pragma once
// A walk up to what stands in front of a camera, and along it: a face against a wall, where each
// splat covers much of the picture.
#include <span>
#include <vector>

#include "tools/cameras.h"
#include "tools/frame_bench.h"

namespace voyager::tools {

inline constexpr double kCloseUp = 0.3;  // metres from the surface

// start: one camera, or two eyes; its size and frustum are kept. `steps` times as many cameras: the
// first half of the steps go straight ahead until the nearest surface in front is kCloseUp away,
// the others to the right, at that distance. The surface is where the depth of the middle of the
// picture says. Empty where there is none.
std::vector<Camera> close_up_cameras(const FrameMaker& maker, std::span<const Camera> start,
                                     size_t steps);

}  // namespace voyager::tools
