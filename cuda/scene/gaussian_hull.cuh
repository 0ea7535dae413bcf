#pragma once
#include <cuda_fp16.h>

#include "cuda/scene/gaussian_view.h"
#include "runtime/math/alpha.h"
#include "runtime/math/vec.h"
#include "runtime/stages/project.h"

namespace voyager::cuda {

// What is known of a Gaussian before the rest of it is read (GaussianView::hulls).
struct GaussianHull {
  Vec3f mean;
  float max_scale;
  float radius_squared;  // of the support, in standard deviations
};

// Upper bounds of what the tables of codes say, without reading them. The scale is too large by at
// most 1e-4 of itself, half the square of the radius by at most 1e-4.
__device__ inline float largest_scale(const ShapeCode& code) {
  constexpr float kStep = kLog2e / static_cast<float>(kLogScaleSteps), kAbove = 1.0f + 0x1p-15f;
  constexpr int kLeast = static_cast<int>(kLeastLogScale * kLogScaleSteps);
  return exp2f(static_cast<float>(static_cast<int>(largest_scale_code(code)) + kLeast) * kStep) *
         kAbove;
}
__device__ inline float support_radius_squared(const ShapeCode& code) {
  constexpr float kAbove = kRhoMargin + 2e-5f;
  const uint32_t q = opacity_code(code);
  const float opacity = has_logit(code)
                            ? static_cast<float>(q) * static_cast<float>(1 / kOpacitySteps)
                            : __half2float(__ushort_as_half(static_cast<uint16_t>(q)));
  return 2.0f * fmaxf(__logf(opacity) - kLogTruthThreshold + kAbove, 0.0f);
}

// Of a coded scene.
__device__ inline Vec3f coded_mean(const GaussianView& gaussians, uint32_t i) {
  const MeanCode* const code = &(static_cast<const CodedHull*>(gaussians.hulls) + i)->mean;
  const float4 grid =
      __ldg(reinterpret_cast<const float4*>(gaussians.mean_grids + gaussians.code_groups(i)));
  return restored_mean({__ldg(&code->low), __ldg(&code->high)}, {{grid.x, grid.y, grid.z}, grid.w});
}
__device__ inline uint32_t coded_bounds(const GaussianView& gaussians, uint32_t i) {
  return __ldg(&(static_cast<const CodedHull*>(gaussians.hulls) + i)->bounds);
}

__device__ inline float4 float_hull(const GaussianView& gaussians, uint32_t i) {
  return __ldg(static_cast<const float4*>(gaussians.hulls) + i);
}

__device__ inline GaussianHull hull_at(const GaussianView& gaussians, uint32_t i) {
  if (gaussians.sh_form == ShForm::coded) {
    const ShapeCode code{coded_bounds(gaussians, i), {}};
    return {coded_mean(gaussians, i), largest_scale(code), support_radius_squared(code)};
  }
  const float4 h = float_hull(gaussians, i);
  const uint32_t bounds = __float_as_uint(h.w);
  const float radius = __uint_as_float(bounds << 16);
  return {{h.x, h.y, h.z}, __uint_as_float(bounds & 0xffff0000u), radius * radius};
}

// The radius of the support above α*, from that of a hull. 0 where α never reaches it.
__device__ inline float radius_above(float radius_squared, float log_threshold) {
  return sqrtf(fmaxf(radius_squared - 2.0f * (log_threshold - kLogTruthThreshold), 0.0f));
}

}  // namespace voyager::cuda
