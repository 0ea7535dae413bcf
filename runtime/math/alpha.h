#pragma once
// METHOD §4, §6–8: the exponential of a splat and what is blended.
//
// The exponentials below are branch-free binary32 built of fused multiply-adds
// and integer steps, so that a compiler can run them in any SIMD width, and
// the result is the same in each. A new exponential is one more function here.
#include <cmath>
#include <cstdint>

#include "runtime/math/float_bits.h"
#include "runtime/math/host_device.h"

namespace voyager {

// Binary32 values of the constants, in every backend (METHOD §6).
inline constexpr float kAlphaMax = 0.99f;
inline constexpr float kAlphaThreshold = 1.0f / 255.0f;  // α*
inline constexpr float kTransmittanceEnd = 1e-4f;
inline constexpr float kLogAlphaThreshold = -5.541263545158426f;  // ln(1/255)

// METHOD §12: α* of the truth.
inline constexpr float kLogTruthThreshold = -9.210340371976182f;  // ln(1e-4)

// METHOD §7: o·e^ρ ≥ α* exactly where ρ ≥ this.
template <class T>
VOYAGER_HD T rho_min(T log_opacity, T log_threshold = T(kLogAlphaThreshold)) {
  return log_threshold - log_opacity;
}

inline constexpr float kLog2e = 1.44269504088896341f;

namespace detail {
// Adding and subtracting 1.5·2²³ rounds to the nearest integer, which then also
// stands in the low bits of the sum.
inline constexpr float kRoundShift = 12582912.0f;
inline constexpr float kLn2High = 0.693359375f, kLn2Low = -2.12194440e-4f;

VOYAGER_HD float power_of_two(float shifted) {  // shifted = n + kRoundShift, n ≥ -126
  return bits_float((float_bits(shifted) << 23) + 0x3f800000u);
}
// e^r - 1 - r over r², for |r| ≤ ln2/2; the series to r⁷/7! leaves less than 6e-9.
VOYAGER_HD float exp_tail(float r) {
  float p = 1.0f / 5040.0f;
  p = std::fma(p, r, 1.0f / 720.0f);
  p = std::fma(p, r, 1.0f / 120.0f);
  p = std::fma(p, r, 1.0f / 24.0f);
  p = std::fma(p, r, 1.0f / 6.0f);
  return std::fma(p, r, 0.5f);
}
}  // namespace detail

// e^x for x ≤ 0, within 2 ulp; below -87 the value at -87.
VOYAGER_HD float exp_negative(float x) {
  x = x < -87.0f ? -87.0f : x;
  const float shifted = std::fma(x, kLog2e, detail::kRoundShift);
  const float n = shifted - detail::kRoundShift;
  const float r = std::fma(n, -detail::kLn2Low, std::fma(n, -detail::kLn2High, x));
  return std::fma(r * r, detail::exp_tail(r), r + 1.0f) * detail::power_of_two(shifted);
}

// 2^x for x ≤ 0, within 2 ulp; below -125 the value at -125.
VOYAGER_HD float exp2_negative(float x) {
  x = x < -125.0f ? -125.0f : x;
  const float shifted = x + detail::kRoundShift;
  const float r = (x - (shifted - detail::kRoundShift)) * 0.693147180559945309f;
  return std::fma(r * r, detail::exp_tail(r), r + 1.0f) * detail::power_of_two(shifted);
}

// e^x - 1 for x ≤ 0, with full relative precision near 0.
VOYAGER_HD float expm1_negative(float x) {
  x = x < -87.0f ? -87.0f : x;
  const float shifted = std::fma(x, kLog2e, detail::kRoundShift);
  const float n = shifted - detail::kRoundShift;
  const float r = std::fma(n, -detail::kLn2Low, std::fma(n, -detail::kLn2High, x));
  const float q = std::fma(r * r, detail::exp_tail(r), r);
  const float scale = detail::power_of_two(shifted);
  return std::fma(scale, q, scale - 1.0f);
}

// ln(1 - a) for 0 ≤ a ≤ kAlphaMax, with full relative precision near 0.
VOYAGER_HD float log1m(float a) {
  const float u = 1.0f - a;
  const float lost = (1.0f - u) - a;  // what rounding u added to it
  // u = m·2^e with m in [√½, √2).
  const uint32_t bits = float_bits(u) - 0x3f3504f3u;
  const float e = static_cast<float>(static_cast<int32_t>(bits) >> 23);
  const float m = bits_float((bits & 0x007fffffu) + 0x3f3504f3u);
  const float s = (m - 1.0f) / (m + 1.0f), ss = s * s;
  float p = 2.0f / 9.0f;
  p = std::fma(p, ss, 2.0f / 7.0f);
  p = std::fma(p, ss, 2.0f / 5.0f);
  p = std::fma(p, ss, 2.0f / 3.0f);
  const float log_m = std::fma(p * ss, s, 2.0f * s);
  const float log_u = std::fma(e, 0.693147180559945309f, log_m);
  return log_u + lost / u;
}

// METHOD §4: k siblings at t = 0 add up to their parent's α. The second form
// keeps its digits for large k. inverse_k = 1/k.
VOYAGER_HD float sibling_alpha(float alpha, float t, float inverse_k) {
  return std::fma(t, alpha, -((1.0f - t) * expm1_negative(log1m(alpha) * inverse_k)));
}
VOYAGER_HD double sibling_alpha(double alpha, double t, double inverse_k) {
  return t * alpha - (1.0 - t) * std::expm1(std::log1p(-alpha) * inverse_k);
}

}  // namespace voyager
