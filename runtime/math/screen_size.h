#pragma once
// METHOD §3: the cut predicate. IEEE binary32, this operation order, no
// contraction, correctly rounded square root and division: every search on
// every backend then agrees to the bit.
#include <cmath>
#include <limits>

#include "runtime/math/vec.h"

namespace voyager {

// Coordinates stay below this magnitude, metres: squared distances then stay finite.
inline constexpr float kMaxCoordinate = 1e18f;

// (2τ + 1) / f_x, in double, rounded once. τ and f_x in pixels.
VOYAGER_HD float target_size(double tau, double focal_x) {
  return static_cast<float>((2.0 * tau + 1.0) / focal_x);
}

// Camera centre in scene-local coordinates, rounded once.
VOYAGER_HD Vec3f cut_centre(const Vec3d& eye, const Vec3d& origin) {
  return {static_cast<float>(eye.x - origin.x), static_cast<float>(eye.y - origin.y),
          static_cast<float>(eye.z - origin.z)};
}

VOYAGER_HD float clamp_to_box(float c, float lo, float hi) {
  return c < lo ? lo : (c > hi ? hi : c);
}

VOYAGER_HD float screen_size(const Vec3f& c, const Vec3f& box_min, const Vec3f& box_max,
                             float extent) {
  const float dx = c.x - clamp_to_box(c.x, box_min.x, box_max.x);
  const float dy = c.y - clamp_to_box(c.y, box_min.y, box_max.y);
  const float dz = c.z - clamp_to_box(c.z, box_min.z, box_max.z);
  const float squared = (dx * dx + dy * dy) + dz * dz;
  if (squared == 0.0f) return std::numeric_limits<float>::infinity();
  return extent / std::sqrt(squared);
}

}  // namespace voyager
