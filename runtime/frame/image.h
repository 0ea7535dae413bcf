#pragma once
// What a frame is drawn into.
#include <cstddef>
#include <cstdint>

#include "runtime/frame/external_ring.h"

namespace voyager {

enum class ColorFormat { none, rgba8, rgba16f, rgba32f };

constexpr size_t pixel_bytes(ColorFormat format) {
  switch (format) {
    case ColorFormat::none:
      return 0;
    case ColorFormat::rgba8:
      return 4;
    case ColorFormat::rgba16f:
      return 8;
    case ColorFormat::rgba32f:
      break;
  }
  return 16;
}

// Where external.ring is set, the frame goes there. Where color is null but format is not
// none, the frame is drawn and handed to nobody: for measurements.
struct Image {
  ColorFormat format = ColorFormat::none;
  uint32_t width = 0, height = 0;
  void* color = nullptr;
  size_t color_pitch = 0;  // bytes
  float* depth = nullptr;
  size_t depth_pitch = 0;  // bytes
  ExternalTarget external = {};
};

}  // namespace voyager
