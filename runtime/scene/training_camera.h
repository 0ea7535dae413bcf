#pragma once
#include <cstdint>

#include "runtime/math/vec.h"

namespace voyager {

// One picture that a scene was trained with, in the scene's world and units. Distortion of a lens
// is left out: trainers undistort their pictures first.
struct TrainingCamera {
  Vec3d position;
  Mat3d world_to_view;    // a rotation; its rows are right, down and forward
  double fx, fy, cx, cy;  // pixels, from the top left corner
  uint32_t width, height;
};

}  // namespace voyager
