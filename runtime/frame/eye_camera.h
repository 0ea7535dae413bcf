#pragma once
// A camera from what hosts say of an eye: an orientation as OpenXR has it, and tangents.
#include "runtime/frame/backend.h"

namespace voyager {

// orientation: unit, from the eye's axes (x right, y up, looking along -z) to the world's. The
// rows of the result are right, down and forward.
inline Mat3d world_to_view(const Quatd& orientation) {
  const Mat3d r = rotation(orientation);
  return {{{r.row[0].x, r.row[1].x, r.row[2].x},
           {-r.row[0].y, -r.row[1].y, -r.row[2].y},
           {-r.row[0].z, -r.row[1].z, -r.row[2].z}}};
}

// Tangents of the half-angles: right and up positive, left < right, down < up. The
// camera's size is set.
inline void set_frustum(Camera& camera, double left, double right, double up, double down) {
  camera.fx = camera.width / (right - left);
  camera.fy = camera.height / (up - down);
  camera.cx = -left * camera.fx;
  camera.cy = up * camera.fy;
}

}  // namespace voyager
