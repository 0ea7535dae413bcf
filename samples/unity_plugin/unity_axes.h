#pragma once
// From Unity's cameras to Voyager's. Unity's world is left-handed: x right, y up, z forward. A
// scene has x right, y down, z forward. So (x, y, z) of the scene stands at (x, -y, z) in Unity.
// Matrices are Matrix4x4 as C# passes them: 16 floats, column by column.
#include <voyager/voyager.h>

namespace voyager_unity {

// `camera_to_world` is Camera.cameraToWorldMatrix. The camera in it looks along -z, as Unity's
// documentation says, so its hand is not the world's. Throws voy::Error, as does frustum().
VoyPose scene_pose(const float (&camera_to_world)[16]);

// `projection` is Camera.projectionMatrix, which follows OpenGL on every platform.
VoyFrustum frustum(const float (&projection)[16]);

}  // namespace voyager_unity
