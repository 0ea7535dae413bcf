#pragma once
// Sums over an array by one thread block.
#include <cstdint>
#include <cub/block/block_scan.cuh>

namespace voyager::cuda {

inline constexpr unsigned kScanThreads = 1024, kScanItems = 4;
using BlockScan = cub::BlockScan<uint32_t, kScanThreads, cub::BLOCK_SCAN_WARP_SCANS>;

// By kScanThreads threads; returns the sum. out(i, item, sum of those before).
template <class In, class Out>
__device__ uint32_t scan(uint32_t count, BlockScan::TempStorage& storage, const In& in,
                         const Out& out) {
  constexpr uint32_t kTile = kScanThreads * kScanItems;
  uint32_t before = 0;
  for (uint32_t tile = 0; tile < count; tile += kTile) {
    uint32_t items[kScanItems], sums[kScanItems], total;
    const uint32_t first = tile + threadIdx.x * kScanItems;
    for (unsigned k = 0; k < kScanItems; ++k) items[k] = first + k < count ? in(first + k) : 0;
    BlockScan(storage).ExclusiveSum(items, sums, total);
    __syncthreads();
    for (unsigned k = 0; k < kScanItems; ++k)
      if (first + k < count) out(first + k, items[k], before + sums[k]);
    before += total;
  }
  return before;
}

}  // namespace voyager::cuda
