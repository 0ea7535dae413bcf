#pragma once
#include <span>
#include <string>

#include "runtime/math/vec.h"
#include "tools/cameras.h"

namespace voyager::tools {

// A camera for a scene that came without any: from above, at an angle, with what most Gaussians
// take up in the picture. Up is -y, as in captured scenes (docs/conventions.md). Reads a part of
// a .voy, and all of a flat file, whose order does not matter. 1280 x 720 pixels.
Camera default_camera(const std::string& scene);

// The same for these positions. A few that lie far away change nothing.
Camera camera_around(std::span<const Vec3d> positions);

}  // namespace voyager::tools
