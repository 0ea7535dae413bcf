#pragma once
// project_slots.cu: what gives candidates their slots, for project.cu.
#include "cuda/splat/splat_launch.h"

namespace voyager::cuda {

// In front of project_cull, where a list's ranks are not its places.
void launch_clear_ranks(const SplatFrame& frame);
// Behind it.
void launch_slots(const SplatFrame& frame);

}  // namespace voyager::cuda
