#pragma once
// NaN, infinity and impossible values are handled here, where they enter.
#include "runtime/math/screen_size.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

inline constexpr float kMinLogScale = -20.7232658f;  // ln 1e-9 m
inline constexpr float kMaxLogScale = 13.8155106f;   // ln 1e6 m

// Mends or drops each Gaussian in place (order kept, arrays compacted) and
// counts into cloud.report; sets report.read to the size before. Each counter
// counts Gaussians, not values; a dropped one is counted once, for the first
// reason in the order position, scale, opacity. What is sound keeps its bits.
void sanitise(GaussianCloud& cloud);

}  // namespace voyager
