#pragma once
#include "runtime/frame/backend.h"
#include "runtime/frame/scene.h"
#include "runtime/stages/project.h"

namespace voyager {

// camera: in the scene's coordinates.
inline ProjectParams project_params(const Scene& scene, const Camera& camera,
                                    Exponential exponential) {
  ProjectParams params;
  params.origin = scene.origin;
  params.eye = camera.eye;
  params.view = view_projection<float>(camera.world_to_view, camera.fx, camera.fy, camera.cx,
                                       camera.cy, camera.width, camera.height);
  params.near_z = static_cast<float>(camera.near_z);
  params.depth_scale = static_cast<float>(camera.depth_scale);
  params.width = static_cast<float>(camera.width);
  params.height = static_cast<float>(camera.height);
  params.log_scale = is_base_2(exponential) ? kLog2e : 1.0f;
  params.half = 0.5f * params.log_scale;
  return params;
}

}  // namespace voyager
