#pragma once
// What formats of a byte or a few bits a value have in common (scene/import).
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "runtime/math/gaussian.h"
#include "runtime/math/sh.h"

namespace voyager {

// The logit of a share of part / (part + rest). Shares of 0 and 1 stand for logits beyond what the
// numbers can say, not for infinity; NaN stays.
inline float logit_of_odds(double part, double rest) {
  if (part <= 0) return -kMaxLogit;
  if (rest <= 0) return kMaxLogit;
  return std::clamp(static_cast<float>(std::log(part / rest)), -kMaxLogit, kMaxLogit);
}

// The logit of an opacity of code / 255, code from 0 to 255.
inline float logit_of_byte(int code) {
  // A logarithm for each Gaussian is a seventh of the time that reading a .spz takes.
  static const std::array<float, 256> logits = [] {
    std::array<float, 256> all{};
    for (int i = 0; i < 256; ++i) all[static_cast<size_t>(i)] = logit_of_odds(i, 255.0 - i);
    return all;
  }();
  return logits[static_cast<size_t>(code)];
}

// The logit of a linear opacity.
inline float logit_of_opacity(double opacity) {
  return logit_of_odds(opacity, 1 - opacity);
}

// What a code stands for that runs from 0 (low) to most (high); exact at both ends.
inline float between(float low, float high, uint32_t code, uint32_t most) {
  const double t = static_cast<double>(code) / most;
  return static_cast<float>((1.0 - t) * static_cast<double>(low) + t * static_cast<double>(high));
}

// The SH coefficient of the constant band that shows a colour, 0 to 1.
inline float sh_of_colour(double colour) {
  return static_cast<float>((colour - 0.5) / kSh0);
}

// Natural logarithm of a linear scale in metres. 0, which is what a small scale was rounded to, is
// by default a scale below any that a Gaussian may have (scene/sanitise.h); a negative one is NaN.
template <class Real>
float log_of_scale(Real scale, float of_zero = -100.0f) {
  return scale == 0 ? of_zero : static_cast<float>(std::log(scale));
}

// Of a unit quaternion's components all but one, which is at `largest` and not negative: fills it.
inline void complete_unit(float* q, int largest) {
  float squared = 0.0f;
  for (int i = 0; i < 4; ++i)
    if (i != largest) squared += q[i] * q[i];
  q[largest] = squared < 1.0f ? std::sqrt(1.0f - squared) : 0.0f;
}

// A unit quaternion as formats store it: which of four components is the largest, and the others in
// their order, of the sign that makes the largest positive. They are at most sqrt(1/2).
inline constexpr float kSqrtHalf = 0.70710678f;
struct SmallestThree {
  int largest = 0;
  std::array<float, 3> others{};
};
// The first of several that are as large.
inline SmallestThree smallest_three(const std::array<float, 4>& q) {
  SmallestThree found;
  for (int i = 1; i < 4; ++i)
    if (std::fabs(q[static_cast<size_t>(i)]) > std::fabs(q[static_cast<size_t>(found.largest)]))
      found.largest = i;
  const float sign = q[static_cast<size_t>(found.largest)] < 0.0f ? -1.0f : 1.0f;
  size_t at = 0;
  for (int i = 0; i < 4; ++i)
    if (i != found.largest) found.others[at++] = sign * q[static_cast<size_t>(i)];
  return found;
}
inline std::array<float, 4> quaternion_of(const SmallestThree& code) {
  std::array<float, 4> q{};
  size_t at = 0;
  for (int i = 0; i < 4; ++i)
    if (i != code.largest) q[static_cast<size_t>(i)] = code.others[at++];
  complete_unit(q.data(), code.largest);
  return q;
}

// A rotation (w, x, y, z) of three bytes: its axis on an octahedron, u and v from -1 to 1, and its
// angle from 0 to pi.
inline std::array<float, 4> rotation_of_oct88r8(uint32_t u, uint32_t v, uint32_t angle) {
  constexpr float kHalfPi = 1.57079633f;
  float x = between(-1, 1, u, 255), y = between(-1, 1, v, 255);
  const float z = 1 - std::fabs(x) - std::fabs(y), folded = std::max(-z, 0.0f);
  x -= std::copysign(folded, x);
  y -= std::copysign(folded, y);
  const float half = between(0, kHalfPi, angle, 255);
  const float of_axis = std::sin(half) / std::sqrt(x * x + y * y + z * z);
  return {std::cos(half), of_axis * x, of_axis * y, of_axis * z};
}

}  // namespace voyager
