#pragma once
#include "cuda/scene/gaussian_view.h"
#include "runtime/math/alpha.h"
#include "runtime/math/vec.h"

namespace voyager::cuda {

// What is known of a Gaussian before the rest of it is read (GaussianView::hulls).
struct GaussianHull {
  Vec3f mean;
  float max_scale, radius;
};

__device__ inline GaussianHull hull_at(const GaussianView& gaussians, uint32_t i) {
  const float4 h = __ldg(gaussians.hulls + i);
  const uint32_t bounds = __float_as_uint(h.w);
  return {{h.x, h.y, h.z}, __uint_as_float(bounds & 0xffff0000u), __uint_as_float(bounds << 16)};
}

// The radius of the support above α*, from the stored one. 0 where α never reaches it.
__device__ inline float radius_above(float stored, float log_threshold) {
  return sqrtf(fmaxf(stored * stored - 2.0f * (log_threshold - kLogTruthThreshold), 0.0f));
}

}  // namespace voyager::cuda
