#pragma once
#include <cmath>

namespace voyager {

// A linear value as sRGB's code value, both 0 to 1; negative ones mirror the positive.
inline double encode_srgb(double linear) {
  const double size = std::fabs(linear);
  const double code = size <= 0.0031308 ? 12.92 * size : 1.055 * std::pow(size, 1 / 2.4) - 0.055;
  return std::copysign(code, linear);
}

}  // namespace voyager
