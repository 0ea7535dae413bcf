#pragma once
#include <span>
#include <string>

#include "tools/cameras.h"

namespace voyager::tools {

// A cameras.json that read_cameras() reads. Throws Error(io).
void write_cameras(const std::string& path, std::span<const Camera> cameras);

}  // namespace voyager::tools
