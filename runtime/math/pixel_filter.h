#pragma once
// METHOD §5 and §12: what is between a Gaussian and a pixel. T is float in the backends and
// double in the reference.
#include <cmath>

#include "runtime/math/vec.h"

namespace voyager {

template <class T>
struct PixelFilter {
  T low_pass;        // pixels², added to Σ'
  T footprint;       // squared units of the scene, added to the variance along each axis
  bool compensated;  // opacity sinks as low_pass widens a splat
};

// 3DGS's own (METHOD §5): widens a splat of any size, and leaves its opacity.
inline constexpr double kLowPass = 0.3;
// The box of a pixel has this variance (METHOD §12).
inline constexpr double kPixelVariance = 1.0 / 12.0;

// METHOD §12: what 3DGS's low-pass adds in a training picture beyond the pixel's own box, where
// `pixel` is the side of that picture's pixel at the Gaussian.
constexpr double native_footprint(double pixel) {
  return (kLowPass - kPixelVariance) * pixel * pixel;
}

template <class T>
VOYAGER_HD Vec3<T> widened(const Vec3<T>& scale, T footprint) {
  using std::sqrt;
  return {sqrt(scale.x * scale.x + footprint), sqrt(scale.y * scale.y + footprint),
          sqrt(scale.z * scale.z + footprint)};
}

}  // namespace voyager
