#pragma once
// One Gaussian in the form that a device has it in: of a scene that is resident and of a chunk
// that is streamed alike, so that they are the same to the bit.
#include <cuda_fp16.h>

#include <cmath>

#include "cuda/scene/gaussian_view.h"
#include "runtime/stages/project.h"

namespace voyager::cuda {

// x ≥ 0, rounded up to 16 bits of a binary32.
VOYAGER_HD uint32_t upper_half(float x) {
  return (float_bits(x) + 0xffffu) >> 16;
}

VOYAGER_HD float4 device_hull(const Gaussian& g) {
  const float rho = rho_min(g.log_opacity, kLogTruthThreshold);
  const float radius = rho <= 0.0f ? std::sqrt(2.0f * (kRhoMargin - rho)) : 0.0f;
  const uint32_t bounds = upper_half(detail::largest(g.scale)) << 16 | upper_half(radius);
  return {g.mean.x, g.mean.y, g.mean.z, bits_float(bounds)};
}

// Of two words.
inline float4 device_shape(const Gaussian& g, size_t word) {
  if (word == 0) return {g.scale.x, g.scale.y, g.scale.z, g.log_opacity};
  return {g.rotation.w, g.rotation.x, g.rotation.y, g.rotation.z};
}

// sh: of one Gaussian. into: half_sh_words() words.
inline void put_half_coefficients(const float* sh, int degree, __half* into) {
  const size_t used = 3 * static_cast<size_t>(sh_coefficients(degree));
  const size_t stride = 8 * static_cast<size_t>(half_sh_words(degree));
  for (size_t k = 0; k < stride; ++k) into[k] = __float2half_rn(k < used ? sh[k] : 0.0f);
}

}  // namespace voyager::cuda
