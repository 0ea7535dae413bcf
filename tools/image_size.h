#pragma once
#include <cstdint>

namespace voyager::tools {

// Of a picture, in pixels.
struct ImageSize {
  uint32_t width = 0, height = 0;  // 0: the camera's own
};

}  // namespace voyager::tools
