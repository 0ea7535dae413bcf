#pragma once
// Codes of numbers from 0 to 1, and the numbers that formats code.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "runtime/math/sh.h"

namespace voyager {

// The nearest of 2^bits evenly spaced codes, the first of which is 0 and the last 1; what is
// outside takes the nearer end, a NaN the first. bits up to 16.
inline uint32_t unit_code(float value, int bits) {
  const float last = static_cast<float>((1u << bits) - 1);
  if (!(value > 0.0f)) return 0;
  return static_cast<uint32_t>(std::min(value, 1.0f) * last + 0.5f);
}

// What f_dc alone makes of a channel, not clamped.
inline float flat_colour(float f_dc) {
  return 0.5f + static_cast<float>(kSh0) * f_dc;
}

}  // namespace voyager
