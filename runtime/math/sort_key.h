#pragma once
// METHOD §6: the depth that orders splats is part of the contract, because
// coplanar splats would otherwise sort by rounding noise.
#include "runtime/math/exact.h"
#include "runtime/math/vec.h"

namespace voyager {

// mean: binary32, scene-local; origin: the scene's; eye: in the scene's coordinates; forward:
// the view axis there, in binary32.
VOYAGER_HD Vec3f camera_relative(const Vec3f& mean, const Vec3d& origin, const Vec3d& eye) {
  return {static_cast<float>((static_cast<double>(mean.x) + origin.x) - eye.x),
          static_cast<float>((static_cast<double>(mean.y) + origin.y) - eye.y),
          static_cast<float>((static_cast<double>(mean.z) + origin.z) - eye.z)};
}

VOYAGER_HD float view_depth(const Vec3f& d, const Vec3f& forward) {
  return add_rn(add_rn(multiply_rn(d.x, forward.x), multiply_rn(d.y, forward.y)),
                multiply_rn(d.z, forward.z));
}

// The sort key: z in metres of the world. scale: the instance's, in binary32; 1 changes no bit.
VOYAGER_HD float sort_depth(float z, float scale) {
  return multiply_rn(scale, z);
}

}  // namespace voyager
