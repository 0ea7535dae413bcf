#pragma once
// Where each tile's list begins and ends, and in which order lists are worked on: for those who
// sort and draw them.
#include <cub/block/block_scan.cuh>

#include "cuda/device/warp.cuh"
#include "cuda/splat/bin_order.cuh"

namespace voyager::cuda {

// Two blocks fill a multiprocessor of 1536 threads (sm_86, sm_87, sm_89).
inline constexpr unsigned kBinThreads = 768;
using BinScan = cub::BlockScan<unsigned long long, kBinThreads, cub::BLOCK_SCAN_WARP_SCANS>;

inline constexpr unsigned kPlacedEach = 2, kPlacedTiles = kPlacedEach * kBinThreads;  // by a block

// A block's, in shared memory.
struct BinPlaces {
  BinScan::TempStorage scan;
  unsigned long long total, before;
  BinOrder order;
};

// By one warp: a region of strips a lane.
__device__ inline void bin_strip_counts(const SplatView& splats) {
  static_assert(kStripRegions == 32);
  const uint32_t strips = *strip_count(splats, threadIdx.x);
  const uint32_t room = splats.strip_room / kStripRegions;
  const auto sum = warp_sum(static_cast<unsigned long long>(strips));
  const auto dropped = warp_sum(static_cast<unsigned long long>(strips > room ? strips - room : 0));
  const unsigned long long most = __reduce_max_sync(kAllLanes, strips);
  if (threadIdx.x != 0) return;
  splats.counters->strips = sum;
  splats.counters->strip_room = most * kStripRegions;
  splats.counters->strips_dropped = dropped;
}

// Adds a warp's values to `sum`, which is the block's.
__device__ inline void bin_add(unsigned long long& sum, unsigned long long value) {
  value = warp_sum(value);
  if (lane_in_warp() == 0) atomicAdd(&sum, value);
}

// Places the tiles of one of the blocks that do. Each counts all tiles for itself, and so waits for
// none. What is beyond the room is cut off. at_once: tiles that are rasterized at a time.
__device__ inline void bin_place(const SplatView& splats, uint32_t at_once, uint32_t block,
                                 BinPlaces& own) {
  const uint32_t tiles = splats.frame.count(), base = block * kPlacedTiles;
  if (threadIdx.x == 0) own.total = own.before = 0;
  own.order.clear();
  unsigned long long all = 0, earlier = 0;
#pragma unroll 4
  for (uint32_t i = threadIdx.x; i < tiles; i += kBinThreads) {
    const uint32_t count = splats.tile_counts[i];
    own.order.count(count, i < base);
    all += count;
    if (i < base) earlier += count;
  }
  bin_add(own.total, all);
  bin_add(own.before, earlier);
  const uint32_t first_tile = base + kPlacedEach * threadIdx.x;
  unsigned long long count[kPlacedEach], first[kPlacedEach];
  for (unsigned k = 0; k < kPlacedEach; ++k)
    count[k] = first_tile + k < tiles ? splats.tile_counts[first_tile + k] : 0;
  BinScan(own.scan).ExclusiveSum(count, first);
  __syncthreads();
  const float share = static_cast<float>(own.total) / static_cast<float>(at_once);
  own.order.place(*splats.counters, max(kLeastHalved, static_cast<uint32_t>(kHalvedShare * share)),
                  block == 0);
  for (unsigned k = 0; k < kPlacedEach; ++k) {
    const uint32_t tile = first_tile + k;
    if (tile >= tiles) break;
    const auto room = static_cast<unsigned long long>(splats.pairs);
    first[k] += own.before;
    splats.tiles[tile] = {static_cast<uint32_t>(min(first[k], room)),
                          static_cast<uint32_t>(min(first[k] + count[k], room))};
    splats.tile_order[own.order.take(static_cast<uint32_t>(count[k]))] = tile;
  }
  if (block != 0) return;
  if (threadIdx.x == 0) splats.counters->pairs = own.total;
  if (threadIdx.x < 32) bin_strip_counts(splats);
}

}  // namespace voyager::cuda
