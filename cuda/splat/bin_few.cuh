#pragma once
// Lists of a second pass with few tiles: each strip is tested against each of these tiles.
#include "cuda/device/warp.cuh"
#include "cuda/splat/bin_place.cuh"
#include "cuda/splat/occlusion.cuh"

namespace voyager::cuda {

// The strips of a thread block.
struct FewStrips {
  const TileStrip* strips;
  uint32_t count;

  // found(index, lanes, key): strips of the warp's lanes that touch the tile of that index.
  template <class Found>
  __device__ void each(const OpenTiles& open, const Found& found) const {
    const uint32_t lane = lane_in_warp();
    for (uint32_t base = threadIdx.x - lane; base < count; base += kBinThreads) {
      const TileStrip strip = base + lane < count ? strips[base + lane] : TileStrip{};
      const DepthKey key = static_cast<DepthKey>(strip.depth) << 32 | strip.slot;
      for (uint32_t i = 0; i < open.count; ++i) {
        const bool touches = open.tiles[i] - strip.first_tile < strip.tiles;
        const unsigned lanes = __ballot_sync(kAllLanes, touches);
        if (lanes != 0) found(i, lanes, key);
      }
    }
  }
};

// One tile's list for each lane, in the order of lanes.
struct FewLists {
  uint32_t tile = 0, length = 0;
  unsigned long long first = 0;

  __device__ explicit FewLists(const SplatView& splats) {
    static_assert(kFewOpen == 32);
    const OpenTiles& open = splats.counters->open;
    const uint32_t lane = lane_in_warp();
    if (lane < open.count) tile = open.tiles[lane], length = splats.tile_counts[tile];
    first = warp_scan(static_cast<unsigned long long>(length)) - length;
  }
};

__device__ inline void count_few(const SplatView& splats, const FewStrips& own) {
  const OpenTiles& open = splats.counters->open;
  own.each(open, [&](uint32_t i, unsigned lanes, DepthKey) {
    if (lane_in_warp() == 0)
      atomicAdd(splats.tile_counts + open.tiles[i], static_cast<uint32_t>(__popc(lanes)));
  });
}

// Once all have been counted.
__device__ inline void scatter_few(const SplatView& splats, const FewStrips& own) {
  OpenTiles& open = splats.counters->open;
  const FewLists lists(splats);
  const uint32_t lane = lane_in_warp();
  own.each(open, [&](uint32_t i, unsigned lanes, DepthKey key) {
    uint32_t taken = 0;
    if (lane == 0) taken = atomicAdd(open.taken + i, static_cast<uint32_t>(__popc(lanes)));
    const unsigned long long at = __shfl_sync(kAllLanes, lists.first, static_cast<int>(i)) +
                                  __shfl_sync(kAllLanes, taken, 0) +
                                  __popc(lanes & ((1u << lane) - 1));
    if (lanes >> lane & 1 && at < splats.pairs) splats.keys[at] = key;
  });
}

// Writes where each list lies, cut off at the room, and their order, longest first. By one warp.
__device__ inline void place_few(const SplatView& splats) {
  const FewLists own(splats);
  SplatCounters& counters = *splats.counters;
  const uint32_t lists = counters.open.count, lane = threadIdx.x;
  uint32_t place = 0;  // in the order
  for (uint32_t other = 0; other < lists; ++other) {
    const uint32_t of_other = __shfl_sync(kAllLanes, own.length, static_cast<int>(other));
    place += of_other > own.length || (of_other == own.length && other < lane);
  }
  const auto room = static_cast<unsigned long long>(splats.pairs);
  if (lane < lists) {
    splats.tiles[own.tile] = {static_cast<uint32_t>(min(own.first, room)),
                              static_cast<uint32_t>(min(own.first + own.length, room))};
    splats.tile_order[place] = own.tile;
  }
  const unsigned large = __ballot_sync(kAllLanes, own.length > kMediumList);
  const unsigned longer = __ballot_sync(kAllLanes, own.length > kShortList);
  bin_strip_counts(splats);
  if (lane != 31) return;
  counters.large_lists = __popc(large);
  counters.long_lists = __popc(longer);
  counters.pairs = own.first + own.length;
}

}  // namespace voyager::cuda
