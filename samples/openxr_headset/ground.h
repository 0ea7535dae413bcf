#pragma once
// Where to stand in a scene of which nothing else is known: on open ground near the middle, with
// the longest view. Found in a small picture of its depth from far above.
#include <voyager/voyager.hpp>

#include "pose.h"

namespace host {

// Half a turn about x: from the scene's axes (captured scenes have y down, by habit) to a frame
// with y up.
Pose scene_from_upright();

// In the upright frame: the eyes, 1.6 m above the ground. In the middle of the bounds where no
// ground is seen.
Pose stand_on_ground(const voy::Device& device, const voy::Scene& scene);

}  // namespace host
