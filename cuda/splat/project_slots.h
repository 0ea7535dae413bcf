#pragma once
// project_slots.cu: what gives candidates their slots, for project.cu.
#include "cuda/splat/splat_launch.h"

namespace voyager::cuda {

// Launch before project_cull, for a list whose ranks are not its places.
void launch_clear_ranks(const SplatFrame& frame);
// Launch after project_cull.
void launch_slots(const SplatFrame& frame);

}  // namespace voyager::cuda
