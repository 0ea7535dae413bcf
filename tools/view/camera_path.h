#pragma once
#include <span>
#include <vector>

#include "camera.h"
#include "tools/cameras.h"

namespace voyager::view {

// The same view as files have it.
tools::Camera file_camera(const host::Camera& camera);

// `count` cameras on a smooth curve through the bookmarks, at equal times from one to the next;
// the first and the last are bookmarks themselves. Lens and size are the first's. One bookmark at
// least, and two cameras.
std::vector<tools::Camera> path_through(std::span<const tools::Camera> bookmarks, size_t count);

}  // namespace voyager::view
