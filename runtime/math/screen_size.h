#pragma once
// METHOD §3: the cut predicate. IEEE binary32, this operation order, no
// contraction, correctly rounded square root and division: every search on
// every backend then agrees to the bit.
#include <cmath>
#include <limits>

#include "runtime/math/exact.h"
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

// Squared distance from c to the box: 0 inside and on it.
VOYAGER_HD float squared_distance(const Vec3f& c, const Vec3f& box_min, const Vec3f& box_max) {
  const float dx = subtract_rn(c.x, clamp_to_box(c.x, box_min.x, box_max.x));
  const float dy = subtract_rn(c.y, clamp_to_box(c.y, box_min.y, box_max.y));
  const float dz = subtract_rn(c.z, clamp_to_box(c.z, box_min.z, box_max.z));
  return add_rn(add_rn(multiply_rn(dx, dx), multiply_rn(dy, dy)), multiply_rn(dz, dz));
}

// extent / √squared, +∞ for 0.
VOYAGER_HD float size_at(float squared, float extent) {
  if (squared == 0.0f) return std::numeric_limits<float>::infinity();
  return divide_rn(extent, sqrt_rn(squared));
}

VOYAGER_HD float screen_size(const Vec3f& c, const Vec3f& box_min, const Vec3f& box_max,
                             float extent) {
  return size_at(squared_distance(c, box_min, box_max), extent);
}

// What the predicate reads of a node, or of many at once; scene-local metres.
struct NodeBounds {
  Vec3f box_min;
  float extent;
  Vec3f box_max;

  VOYAGER_HD float screen_size(const Vec3f& c) const {
    return voyager::screen_size(c, box_min, box_max, extent);
  }
};

}  // namespace voyager
