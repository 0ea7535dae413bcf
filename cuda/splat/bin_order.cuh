#pragma once
// Tiles by the lengths of their lists, longest first: the longest must not start last, and
// sort.cu treats the classes of lengths differently.
#include "cuda/device/warp.cuh"
#include "cuda/splat/splats.h"

namespace voyager::cuda {

// A counting sort by the leading bits of the length, in the shared memory of a block that counts
// all tiles and places some of them.
struct BinOrder {
  static constexpr unsigned kBits = 2;  // beside the highest that is set
  static constexpr unsigned kClasses = 33 << kBits;
  uint32_t places[kClasses], before[kClasses];

  static __device__ unsigned class_of(uint32_t count) {
    const unsigned bits = 32 - __clz(count);
    const unsigned lower = bits > kBits ? count >> (bits - 1 - kBits) & ((1u << kBits) - 1) : 0;
    return kClasses - 1 - (bits << kBits | lower);
  }

  // By all threads of the block together, as the others are.
  __device__ void clear() {
    for (unsigned i = threadIdx.x; i < kClasses; i += blockDim.x) places[i] = before[i] = 0;
    __syncthreads();
  }
  // is_before: the tile is placed by a block before this one.
  __device__ void count(uint32_t length, bool is_before) {
    const unsigned of = class_of(length);
    atomicAdd(places + of, 1u);
    if (is_before) atomicAdd(before + of, 1u);
  }

  // From counts to first places. halved: the length from which on a tile is drawn in halves. tells:
  // of the blocks one, which tells how many lists there are of which lengths.
  __device__ void place(SplatCounters& counters, uint32_t halved, bool tells) {
    __syncthreads();
    if (threadIdx.x < 32) sum_up();
    __syncthreads();
    if (tells && threadIdx.x == 0) {
      counters.large_lists = places[class_of(kMediumList)];
      counters.long_lists = places[class_of(kShortList)];
      counters.halved_lists = min(places[class_of(halved)], kMaxHalvedLists);
    }
    __syncthreads();
    for (unsigned i = threadIdx.x; i < kClasses; i += blockDim.x) places[i] += before[i];
    __syncthreads();
  }
  __device__ uint32_t take(uint32_t length) { return atomicAdd(places + class_of(length), 1u); }

 private:
  // By one warp: its lanes have so many classes each.
  __device__ void sum_up() {
    constexpr unsigned kEach = (kClasses + 31) / 32;
    const unsigned lane = lane_in_warp();
    uint32_t own[kEach], sum = 0;
#pragma unroll
    for (unsigned k = 0; k < kEach; ++k) {
      const unsigned at = lane * kEach + k;
      own[k] = sum;
      sum += at < kClasses ? places[at] : 0;
    }
    const uint32_t through = warp_scan(sum);
    __syncwarp();
#pragma unroll
    for (unsigned k = 0; k < kEach; ++k)
      if (lane * kEach + k < kClasses) places[lane * kEach + k] = through - sum + own[k];
  }
};

}  // namespace voyager::cuda
