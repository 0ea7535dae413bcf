#pragma once
// An image that a report keeps, so that one that goes on does not draw it again.
#include <filesystem>
#include <functional>

#include "runtime/frame/backend.h"
#include "tools/metrics/image_error.h"

namespace voyager::tools {

// What is in the file if that has the size of the camera's image; else what draw() gives, which is
// then in the file.
RgbaImage kept_image(const std::filesystem::path& path, const voyager::Camera& camera,
                     const std::function<RgbaImage()>& draw);

}  // namespace voyager::tools
