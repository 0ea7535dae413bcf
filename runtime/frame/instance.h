#pragma once
// Instances: scenes drawn elsewhere, turned and scaled, by moving the camera the other way.
#include "runtime/frame/backend.h"

namespace voyager {

// The camera in the coordinates of a scene that stands at p + s·R·x. Of what the camera sees,
//   z = a·(p + s·R·x - eye) = s·(Rᵀa)·(x - eye'),   eye' = Rᵀ(eye - p)/s
// for each row a of world_to_view, so that eye', the rows Rᵀa and near/s with the same fx to cy
// give the same picture, and the same sizes on screen (METHOD §3); z is s times theirs. The
// identity changes no bit of it.
inline Camera camera_in_scene(const Camera& camera, const InstancePose& pose) {
  Mat3d inverse;  // Rᵀ
  for (int i = 0; i < 3; ++i)
    inverse.row[i] = {pose.rotation.row[0][i], pose.rotation.row[1][i], pose.rotation.row[2][i]};
  Camera moved = camera;
  const Vec3d eye = inverse * (camera.eye - pose.position);
  moved.eye = {eye.x / pose.scale, eye.y / pose.scale, eye.z / pose.scale};
  for (Vec3d& axis : moved.world_to_view.row) axis = inverse * axis;
  moved.near_z = camera.near_z / pose.scale;
  moved.depth_scale = camera.depth_scale * pose.scale;
  return moved;
}

// An eye's, of the view's instance with that index.
inline Camera instance_camera(const FrameInput& frame, const FrameEye& eye, size_t instance) {
  if (frame.instances.empty()) return eye.camera;
  return camera_in_scene(eye.camera, frame.instances[instance]);
}

inline InstanceLook instance_look(const FrameInput& frame, size_t instance) {
  return frame.looks.empty() ? InstanceLook{} : frame.looks[instance];
}

}  // namespace voyager
