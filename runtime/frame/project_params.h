#pragma once
#include <cmath>

#include "runtime/frame/backend.h"
#include "runtime/frame/scene.h"
#include "runtime/stages/project.h"

namespace voyager {

// What a scene is drawn with (METHOD §12), or 3DGS's own: also where nobody knows the scene's
// native pixel, which a file of an older version does not say.
template <class T>
PixelFilter<T> pixel_filter(const Scene& scene, Antialias antialias) {
  if (antialias == Antialias::off || scene.native.source == NativeSource::unknown)
    return {T(kLowPass), T(0), false};
  return {T(scene.native.low_pass), T(scene.native.footprint()), true};
}

inline float log_threshold(Antialias antialias) {
  return antialias == Antialias::truth ? kLogTruthThreshold : kLogAlphaThreshold;
}

// Tables and binary16 reach no further down than METHOD §6's α*.
inline void require_exponential_for_truth(const PipelineDesc& desc) {
  if (desc.antialias == Antialias::truth && desc.exponential != Exponential::exact &&
      desc.exponential != Exponential::ex2)
    throw Error(ErrorCode::unsupported,
                "exponential: found lut or half2 with the truth's samples, expected exact or ex2");
}

// camera: in the scene's coordinates. look: the instance's.
inline ProjectParams project_params(const Scene& scene, const Camera& camera,
                                    const PipelineDesc& desc, const InstanceLook& look = {}) {
  ProjectParams params;
  params.origin = scene.origin;
  params.eye = camera.eye;
  params.view = view_projection<float>(camera.world_to_view, camera.fx, camera.fy, camera.cx,
                                       camera.cy, camera.width, camera.height);
  params.near_z = static_cast<float>(camera.near_z);
  params.depth_scale = static_cast<float>(camera.depth_scale);
  params.width = static_cast<float>(camera.width);
  params.height = static_cast<float>(camera.height);
  params.filter = pixel_filter<float>(scene, desc.antialias);
  params.log_scale = is_base_2(desc.exponential) ? kLog2e : 1.0f;
  params.log_threshold = log_threshold(desc.antialias);
  params.half = 0.5f * params.log_scale;
  params.opacity = look.opacity;
  params.log_opacity = std::log(look.opacity);
  params.clip = local_clip(look.clip, scene.origin);
  return params;
}

}  // namespace voyager
