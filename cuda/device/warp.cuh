#pragma once
#include <cuda_runtime_api.h>

namespace voyager::cuda {

inline constexpr unsigned kAllLanes = 0xffffffffu;  // a warp's

__device__ inline unsigned lane_in_warp() {
  return threadIdx.x % 32;
}

// By the whole warp: the sum over this lane and those below it, for the first kLanes lanes.
template <unsigned kLanes = 32, class Number>
__device__ Number warp_scan(Number value) {
#pragma unroll
  for (unsigned step = 1; step < kLanes; step *= 2) {
    const Number lower = __shfl_up_sync(kAllLanes, value, step);
    if (lane_in_warp() >= step) value += lower;
  }
  return value;
}

// By the whole warp: the sum over all lanes, for each of them. Of 32 bits __reduce_add_sync() is
// faster.
template <class Number>
__device__ Number warp_sum(Number value) {
#pragma unroll
  for (int step = 16; step != 0; step /= 2) value += __shfl_xor_sync(kAllLanes, value, step);
  return value;
}

}  // namespace voyager::cuda
