#pragma once
// Where things stand in a scene of which only the bounds are known. Captured scenes have y
// down and z forward, by habit.
#include <voyager/voyager.h>

#include <glm/mat4x4.hpp>

#include "camera.h"
#include "options.h"

namespace host {

// A mesh (glTF's axes, y up) that is about 2 units wide, on the ground. That is in the middle
// of bounds that large Gaussians of the ground widen as much upwards as downwards.
glm::dmat4 place_mesh(const VoySceneInfo& scene, const std::optional<MeshPlace>& place);
// From behind and above, as a whole.
VoyPose overview(const VoySceneInfo& scene);
double diagonal(const VoySceneInfo& scene);

}  // namespace host
