#pragma once
// Rotations, mirrors and scales for tests.
#include <cmath>

#include "runtime/math/affine.h"

namespace voyager::test {

inline Mat3d times(double scale, const Mat3d& m) {
  return {{scale * m.row[0], scale * m.row[1], scale * m.row[2]}};
}

inline Mat3d diagonal(double x, double y, double z) {
  return {{{x, 0, 0}, {0, y, 0}, {0, 0, z}}};
}

// By any quaternion but zero.
inline Mat3d turn(double w, double x, double y, double z) {
  return rotation(normalise(Quatd{w, x, y, z}));
}

}  // namespace voyager::test
