#pragma once
// IEEE binary16, round to nearest even: images and compact storage.
#include <bit>
#include <cmath>
#include <cstdint>

#include "runtime/math/host_device.h"

namespace voyager {

inline constexpr float kMaxHalf = 65504.0f;

// Always finite: what lies beyond ±kMaxHalf, infinities and NaNs too, becomes ±kMaxHalf.
VOYAGER_HD uint16_t float_to_half(float value) {
  const uint16_t sign = std::signbit(value) ? 0x8000 : 0;
  const float magnitude = std::fmin(std::fabs(value), kMaxHalf);
  if (magnitude < 0x1p-14f)  // subnormal: a multiple of 2^-24
    return static_cast<uint16_t>(sign | static_cast<uint16_t>(std::nearbyint(magnitude * 0x1p24f)));
  const uint32_t bits = std::bit_cast<uint32_t>(magnitude);
  const uint32_t even = (bits >> 13) & 1;  // a tie goes to the even neighbour
  return static_cast<uint16_t>(sign | ((bits - (112u << 23) + 0xfff + even) >> 13));
}

VOYAGER_HD float half_to_float(uint16_t half) {
  const uint32_t sign = static_cast<uint32_t>(half & 0x8000) << 16, rest = half & 0x7fff;
  if (rest < 0x400) {
    const float magnitude = static_cast<float>(rest) * 0x1p-24f;
    return sign ? -magnitude : magnitude;
  }
  const uint32_t exponent =
      rest >= 0x7c00 ? 224u << 23 : 112u << 23;  // infinities and NaNs keep theirs
  return std::bit_cast<float>(sign | ((rest << 13) + exponent));
}

}  // namespace voyager
