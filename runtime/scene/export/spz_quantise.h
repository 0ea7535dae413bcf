#pragma once
// INRIA words to .spz codes: nearest step, clamped to the format's range
// (a NaN takes the lowest code). Each function names its inverse's file:
// runtime/scene/import/spz_decode.cpp.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "runtime/math/byte_code.h"
#include "runtime/math/gaussian.h"
#include "runtime/scene/spz_format.h"

namespace voyager::spz {

inline uint8_t quantise_byte(float steps) {
  if (!(steps > 0.0f)) return 0;
  return static_cast<uint8_t>(std::min(steps + 0.5f, 255.0f));
}

inline uint8_t quantise_alpha(float opacity_logit) {
  return quantise_byte(sigmoid(opacity_logit) * 255.0f);
}
inline uint8_t quantise_colour(float f_dc) {
  return quantise_byte((f_dc * kColourScale + 0.5f) * 255.0f);
}
inline uint8_t quantise_scale(float log_scale) {
  return quantise_byte((log_scale + 10.0f) * 16.0f);
}
inline uint8_t quantise_sh(float coefficient, int sign) {
  return quantise_byte(static_cast<float>(sign) * coefficient * 128.0f + 128.0f);
}

// Smallest three: the index (x, y, z, w) of the largest component in the top
// two bits, then the others in order, a sign and nine bits of magnitude each.
inline uint32_t quantise_rotation(const Quatf& any_length, const HalfTurn& to_inria) {
  const Quatf unit = normalise(any_length);
  const Vec3f axis = to_inria * Vec3f{unit.x, unit.y, unit.z};
  const SmallestThree three = smallest_three({axis.x, axis.y, axis.z, unit.w});
  auto code = static_cast<uint32_t>(three.largest);
  for (const float other : three.others) {
    const float steps = std::fabs(other) / kSqrtHalf * kRotationSteps + 0.5f;
    const uint32_t magnitude = std::min(static_cast<uint32_t>(steps), uint32_t{kRotationSteps});
    const bool negative = magnitude > 0 && other < 0.0f;
    code = (code << 10) | (negative ? 1u << 9 : 0u) | magnitude;
  }
  return code;
}

}  // namespace voyager::spz
