#pragma once
// A camera, and the matrices that this host draws meshes with.
#include <voyager/voyager_vulkan.h>

#include <glm/mat4x4.hpp>

namespace host {

struct Camera {
  VoyPose pose;  // OpenXR axes (x right, y up, -z forward), in the scene's world
  VoyFrustum frustum;
  uint32_t width, height;
};

// How this host's depth buffer encodes metres.
struct DepthConvention {
  VoyDepthEncoding encoding;
  double near_z, far_z;  // metres; far_z is infinite where reversed

  double far_plane() const { return encoding == VOY_DEPTH_ENCODING_REVERSED ? 0 : 1; }
  float metres(float depth) const;  // +inf at the far plane
};

// Vulkan's clip space (y down, depth 0 to 1) from view space (OpenXR axes).
glm::dmat4 clip_from_view(const VoyFrustum& frustum, const DepthConvention& depth);
// From the scene's world. In double: a city may lie far from the origin.
glm::dmat4 view_from_world(const VoyPose& pose);

}  // namespace host
