#pragma once
// METHOD §12: at what size a scene's Gaussians were seen when they were trained, and with what
// filter, so that it can be drawn at any other.
#include <cmath>
#include <cstdint>

#include "runtime/math/node_code.h"
#include "runtime/math/pixel_filter.h"

namespace voyager {

// Where it is known from. The numbers are those of a .voy's header.
enum class NativeSource : uint32_t {
  unknown = 0,
  given = 1,      // by whoever baked the scene
  cameras = 2,    // the training cameras
  file = 3,       // the input says that it was trained with a compensated filter
  estimated = 4,  // from the Gaussians
};

inline constexpr double kMaxNativePixel = 1e6;  // metres, as scales of Gaussians are bounded
inline constexpr double kMaxLowPass = 100;      // pixels²

struct NativeScale {
  NativeSource source = NativeSource::unknown;
  // The side of a training picture's pixel where the Gaussian is, metres; 0 adds no footprint. The
  // largest where Gaussians have different ones.
  double pixel = 0;
  double low_pass = kPixelVariance;  // of the pixel filter, pixels²
  // Footprint levels (node_code.h) that Gaussians may have, 1 to kFootprintLevels.
  int levels = 1;

  double footprint() const { return native_footprint(pixel); }  // metres², of level 0
  double pixel_of(int level) const { return pixel * std::sqrt(footprint_at(1.0, level)); }
  // The level whose pixel is off from this one by the least factor.
  int level_of(double of_pixel) const {
    const double share = of_pixel / pixel;
    int level = 0;
    while (level + 1 < levels && share * share < footprint_at(std::sqrt(0.5), level)) ++level;
    return level;
  }
  // The input says that it was trained with a compensated filter.
  bool antialiased() const { return source == NativeSource::file; }

  bool operator==(const NativeScale&) const = default;
};

// Of an input that was trained with a compensated filter of this low-pass: it is drawn with the
// same one, and has no footprint beside it.
inline NativeScale compensated_scale(double low_pass) {
  return {NativeSource::file, 0, low_pass};
}
inline constexpr double kMipSplattingLowPass = 0.1;  // Mip-Splatting's and Brush's

}  // namespace voyager
