#pragma once
// METHOD §6–8 at one pixel, on the device.
#include <limits>

#include "cuda/splat/splats.h"
#include "runtime/math/alpha.h"
#include "runtime/math/alpha_lut.h"

namespace voyager::cuda {

inline constexpr float kInfinity = std::numeric_limits<float>::infinity();

__device__ inline float ex2(float x) {
  float y;
  asm("ex2.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  return y;
}
// Of a number that is not denormal.
__device__ inline float reciprocal(float x) {
  float y;
  asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  return y;
}
__device__ inline float lg2(float x) {
  float y;
  asm("lg2.approx.ftz.f32 %0, %1;" : "=f"(y) : "f"(x));
  return y;
}

template <Exponential E>
__device__ inline float alpha_of(float log_alpha, const float* lut, float lut_scale) {
  float alpha;
  if constexpr (E == Exponential::ex2)
    alpha = ex2(log_alpha);
  else if constexpr (E == Exponential::lut)
    alpha = lut[alpha_lut_index(log_alpha, lut_scale)];
  else
    alpha = expf(log_alpha);
  return fminf(alpha, kAlphaMax);
}

// Splats of a warp differ in what METHOD §4's correction asks of them: none has siblings in
// the blend (t = 1), some have few, some have many.
enum class Siblings { none, few, many };

// For few siblings 1 - (1 - α)^(1/k) is found as it stands: it is then off by 2e-7, and what
// k of them add up to by that many times k.
inline constexpr float kManySiblings = 1.0f / 64.0f;  // 1/k below this

template <Exponential E>
__device__ constexpr Siblings siblings_of(float t, float inverse_k) {
  if (t == 1.0f) return Siblings::none;
  return E == Exponential::exact || inverse_k < kManySiblings ? Siblings::many : Siblings::few;
}

// kMost: no splat of the loop has more. What comes out for a splat does not depend on it.
template <Exponential E, Siblings kMost>
__device__ inline float blended_alpha(float alpha, float t, float inverse_k) {
  if constexpr (kMost == Siblings::none) return alpha;
  float corrected;
  if (kMost == Siblings::many && siblings_of<E>(t, inverse_k) == Siblings::many) {
    corrected = sibling_alpha(alpha, t, inverse_k);
  } else {
    const float each = 1.0f - ex2(lg2(1.0f - alpha) * inverse_k);
    corrected = fmaf(t, alpha - each, each);
  }
  return t == 1.0f ? alpha : corrected;
}

// A pixel in progress.
struct RasterPixel {
  float r = 0.0f, g = 0.0f, b = 0.0f;
  float transmittance = 1.0f;  // negative once the pixel has ended
  float depth = kInfinity;
  float halfway = 0.5f;  // the T at which depth is found; -1 once it is
  float farthest;        // the z up to which splats contribute, where depth is limited

  // It then takes no more splats.
  __device__ void end() { transmittance = -fabsf(transmittance); }
  __device__ bool ended() const { return transmittance < 0.0f; }
};

}  // namespace voyager::cuda
