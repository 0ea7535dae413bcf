#include "unity_axes.h"

#include <algorithm>
#include <voyager/voyager.hpp>

namespace voyager_unity {
namespace {

void in_double(const float (&from)[16], double (&to)[16]) {
  std::copy(from, from + 16, to);
}

}  // namespace

VoyPose scene_pose(const float (&camera_to_world)[16]) {
  double matrix[16];
  in_double(camera_to_world, matrix);
  VoyPose pose;
  voy::check(voyPoseFromWorldMatrix(matrix, VOY_HAND_LEFT, &pose));
  // Half a turn about x, to the scene's y down and z forward.
  const double(&p)[3] = pose.position, (&q)[4] = pose.orientation;
  return {{p[0], -p[1], -p[2]}, {q[3], -q[2], q[1], -q[0]}};
}

VoyFrustum frustum(const float (&projection)[16]) {
  double matrix[16];
  in_double(projection, matrix);
  VoyFrustum tangents;
  voy::check(voyFrustumFromProjection(matrix, VOY_CLIP_Y_UP, &tangents));
  return tangents;
}

}  // namespace voyager_unity
