#pragma once
#include <cuda_runtime_api.h>

namespace voyager::cuda {

inline constexpr unsigned kAllLanes = 0xffffffffu;  // a warp's

__device__ inline unsigned lane_in_warp() {
  return threadIdx.x % 32;
}

}  // namespace voyager::cuda
