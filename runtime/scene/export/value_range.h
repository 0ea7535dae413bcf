#pragma once
// The values that formats of few bits hold; their writers clamp others.
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "runtime/math/sh.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

inline constexpr float kAnyValue = std::numeric_limits<float>::infinity();

// Both ends are held. Words before activation.
struct ValueRange {
  float least_log_scale = -kAnyValue, most_log_scale = kAnyValue;
  float most_f_dc = kAnyValue;  // either way
  float most_sh = kAnyValue;    // of degree 1 to 3, either way
  const char* words = "";       // the same for people
};

// The last code of SH is 127/128; what is clamped up to 1 is off by less than two roundings.
inline constexpr ValueRange kSpzRange = {-10.0f, 5.9375f, 10.0f / 3.0f, 1.0f,
                                         "log scales from -10 to 5.94, f_dc from -3.33 to 3.33, "
                                         "SH of degree 1 to 3 from -1 to 1"};
inline constexpr ValueRange kSplatRange = {-kAnyValue, kAnyValue, static_cast<float>(0.5 / kSh0),
                                           kAnyValue, "colours from 0 to 1"};
inline constexpr ValueRange kCompressedPlyRange = {-kAnyValue, kAnyValue, kAnyValue, 4.0f,
                                                   "SH of degree 1 to 3 from -4 to 4"};

// For each range, how many Gaussians of the batch have a value outside. All values are finite, as
// importers and the reader of .voy make sure.
std::vector<uint64_t> count_outside(std::span<const ValueRange> ranges, const GaussianCloud& batch);

}  // namespace voyager
