#pragma once
// What every metric compares: two images as a screen shows them.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "tools/metrics/plane.h"

namespace voyager::tools {

using RgbaImage = std::vector<float>;  // r, g, b, a of each pixel, row by row

inline double on_screen(float value) {
  return std::clamp(value, 0.0f, 1.0f);
}

inline bool is_finite(const float* colour) {
  return std::isfinite(colour[0]) && std::isfinite(colour[1]) && std::isfinite(colour[2]);
}

// Display-referred code values in [0, 1]; what lies beyond is clamped, alpha is left out.
struct ScreenPair {
  std::array<Plane, 3> image, expected;  // r, g, b
  // Pixels at which one of the two, or both, has a colour that is not finite. They are white in
  // `image` and black in `expected`: as wrong as a pixel can be, whatever the other image has.
  std::vector<size_t> not_finite;
};

// Both images have the same size, which is a whole number of rows; width > 0.
ScreenPair screen_pair(const RgbaImage& image, const RgbaImage& expected, size_t width);

}  // namespace voyager::tools
