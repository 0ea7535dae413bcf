#pragma once
// INRIA cameras.json: width, height, position, rotation (camera to world, as rows), fx, fy
// and optionally cx, cy; the camera's axes are x right, y down, z forward.
#include <string>
#include <vector>

#include "camera.h"

namespace host {

// At least one. Throws Failure(kRefusedInput) naming file, camera, field and what was expected.
std::vector<Camera> read_cameras(const std::string& path);

}  // namespace host
