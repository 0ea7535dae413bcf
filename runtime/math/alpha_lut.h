#pragma once
// METHOD §8: the table that can replace the exponential. It is indexed by
// log α = ρ + log o, because a merged Gaussian with o > 1 has valid ρ below the
// table; entry i is e^(-5.55·i/m), and the index reaches m.
#include <cmath>
#include <cstdint>

#include "runtime/math/host_device.h"

namespace voyager {

inline constexpr float kLutRange = 5.55f;  // ln 255 is 5.541
inline constexpr uint32_t kMaxLutSize = 4096;

VOYAGER_HD void fill_alpha_lut(uint32_t m, float* entries) {  // m + 1 entries
  for (uint32_t i = 0; i <= m; ++i)
    entries[i] = static_cast<float>(std::exp(-static_cast<double>(kLutRange) * i / m));
}

// log_alpha may be out of the range; it is clamped. scale = m / kLutRange.
VOYAGER_HD int32_t alpha_lut_index(float log_alpha, float scale) {
  const float below = log_alpha < -kLutRange ? -kLutRange : log_alpha;
  const float x = below > 0.0f ? 0.0f : below;
  return static_cast<int32_t>(std::fma(-x, scale, 0.5f));
}

}  // namespace voyager
