#pragma once
// From Godot's cameras to Voyager's. Godot's world is right-handed: x right, y up, -z forward,
// metres. A scene has x right, y down, z forward. So (x, y, z) of the scene stands at (x, -y, -z)
// in Godot: half a turn about x.
#include <voyager/voyager.h>

namespace voyager_godot {

// A Transform3D as Godot stores it: the basis row by row, then the origin.
using Transform = float[12];
// A Projection as Godot stores it: four columns. It follows OpenGL; Godot reverses depth later.
using Projection = float[16];

// `camera`: RenderSceneData.get_cam_transform(), without scale.
VoyPose scene_pose(const Transform& camera);

// `projection`: RenderSceneData.get_cam_projection().
bool is_perspective(const Projection& projection);
VoyFrustum frustum(const Projection& projection);
double near_plane(const Projection& projection);  // metres

}  // namespace voyager_godot
