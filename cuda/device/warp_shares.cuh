#pragma once
// Work of very different sizes, one piece a lane, to be shared out evenly over the warp.
#include <cstdint>

#include "cuda/device/warp.cuh"

namespace voyager::cuda {

// All members are called by the whole warp together.
class WarpShares {
 public:
  // count: how many items the lane's piece has.
  __device__ explicit WarpShares(uint32_t count) {
    const uint32_t through = warp_scan(count);
    before_ = through - count;
    total_ = __shfl_sync(kAllLanes, through, 31);
  }

  // Items of the lanes below, and of all.
  __device__ uint32_t before() const { return before_; }
  __device__ uint32_t total() const { return total_; }

 private:
  uint32_t before_, total_;
};

}  // namespace voyager::cuda
