#pragma once
#include "cuda/train/train_launch.h"

namespace voyager::cuda {

// What is no number is left out; what is beyond kFixedMost counts as that.
__device__ inline void add_fixed(FixedSum* sum, float value) {
  if (value != value) return;
  value = fminf(fmaxf(value, -kFixedMost), kFixedMost);
  atomicAdd(sum, static_cast<FixedSum>(__float2ll_rn(value * kFixedOne)));
}
__device__ inline float fixed_value(FixedSum sum) {
  return static_cast<float>(static_cast<long long>(sum)) / kFixedOne;
}

__device__ inline float squared_error(const TrainPictures& pictures, uint32_t pixel) {
  const float4 drawn = __ldg(pictures.drawn + pixel), truth = __ldg(pictures.truth + pixel);
  const float r = drawn.x - truth.x, g = drawn.y - truth.y, b = drawn.z - truth.z;
  return r * r + g * g + b * b;
}

}  // namespace voyager::cuda
