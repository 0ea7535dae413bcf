// Between finding a cut and writing it down: where each block's nodes go in the list, which
// blocks are to be written, and the frame's counters.
#include <cub/block/block_scan.cuh>

#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/search/search_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kScanThreads = 1024, kScanItems = 4;
constexpr unsigned kScanTile = kScanThreads * kScanItems;
using BlockScan = cub::BlockScan<uint32_t, kScanThreads, cub::BLOCK_SCAN_WARP_SCANS>;

// One thread block; returns the sum. out(i, item, sum of those before).
template <class In, class Out>
__device__ uint32_t scan(uint32_t count, BlockScan::TempStorage& storage, const In& in,
                         const Out& out) {
  uint32_t before = 0;
  for (uint32_t tile = 0; tile < count; tile += kScanTile) {
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

// Segments that have no room for their nodes. Where more are found than are kept, all move: one
// warp makes room for each in turn, which by then takes longer.
struct Outgrown {
  static constexpr uint32_t kMost = 64;
  uint32_t count;
  uint32_t segments[kMost];
};

__device__ void find_outgrown(const StateView& state, const Block& block, Outgrown& outgrown) {
  for (uint32_t level = 0; level < kLevels; ++level) {
    const uint32_t i = block.first_segment + level * block.stride;
    if (state.segments[i].size <= state.segments[i].room) continue;
    const uint32_t at = atomicAdd(&outgrown.count, 1u);
    if (at < Outgrown::kMost) outgrown.segments[at] = i;
  }
}

// The blocks to be written, each once.
struct Dirty {
  uint32_t* blocks;
  uint32_t* flags;
  uint32_t count;

  __device__ void add(uint32_t block) {
    if (atomicExch(flags + block, 1u) == 0) blocks[atomicAdd(&count, 1u)] = block;
  }
};

__device__ uint32_t block_of_segment(const StateView& state, uint32_t segment) {
  uint32_t tier = 0;
  while (tier + 1 < state.tier_count && segment >= kLevels * state.tiers[tier + 1].first_block)
    ++tier;
  const Tier& own = state.tiers[tier];
  return own.first_block + (segment - kLevels * own.first_block) % own.blocks;
}

// What a segment needs when its neighbours make room: less to spare than a roomy one has.
__device__ uint32_t least_room(uint32_t size, SegmentFit fit) {
  if (size == 0 || fit != SegmentFit::roomy) return whole_rows(size);
  return whole_rows(size + size / 16 + kRowPlaces);
}

// Of `rows` that are shared out by need, what those have that need the first `ahead` of `need`
// places.
__device__ uint32_t spare_before(uint32_t rows, uint32_t ahead, uint32_t need) {
  return need == 0 ? 0 : static_cast<uint32_t>(uint64_t{rows} * ahead / need) * kRowPlaces;
}

// Shares the room of [first, last) out anew, by what each needs.
__device__ void share_room(const StateView& state, SegmentFit fit, uint32_t first, uint32_t last,
                           uint32_t need, uint32_t room, Dirty& dirty) {
  const uint32_t lane = lane_in_warp(), rows = (room - need) / kRowPlaces;
  const uint32_t begin = state.segments[first].first;
  uint32_t before = 0;  // needed by those in front
  for (uint32_t base = first; base < last; base += 32) {
    const uint32_t i = base + lane;
    const uint32_t size = i < last ? state.segments[i].size : 0, own = least_room(size, fit);
    const uint32_t behind = before + warp_scan(own), ahead = behind - own;
    __syncwarp();
    if (i < last) {
      const uint32_t spare = spare_before(rows, ahead, need);
      state.segments[i].first = begin + ahead + spare;
      state.segments[i].room = own + spare_before(rows, behind, need) - spare;
      if (size != 0) dirty.add(block_of_segment(state, i));
    }
    before = __shfl_sync(kAllLanes, behind, 31);
  }
}

// Moves as few of a segment's neighbours as there have to be for it to have room. One warp. False
// where all of them together have none.
__device__ bool make_room(const StateView& state, SegmentFit fit, uint32_t segment, Dirty& dirty) {
  const uint32_t count = kLevels * state.block_count, lane = lane_in_warp();
  if (state.segments[segment].size <= state.segments[segment].room) return true;
  for (uint32_t width = 16;; width *= 2) {
    const uint32_t first = segment / width * width, last = min(first + width, count);
    uint32_t need = 0, room = 0;
    for (uint32_t i = first + lane; i < last; i += 32) {
      need += least_room(state.segments[i].size, fit);
      room += state.segments[i].room;
    }
    need = __reduce_add_sync(kAllLanes, need), room = __reduce_add_sync(kAllLanes, room);
    if (need <= room) {
      share_room(state, fit, first, last, need, room, dirty);
      return true;
    }
    if (first == 0 && last == count) return false;
  }
}

// Gives all segments new places, with new room; returns how many they need. rows: that they share
// out beside that.
__device__ uint32_t set_places(const StateView& state, SegmentFit fit, uint32_t rows, uint32_t need,
                               BlockScan::TempStorage& storage) {
  return scan(
      kLevels * state.block_count, storage,
      [&](uint32_t i) { return segment_room(state.segments[i].size, fit); },
      [&](uint32_t i, uint32_t own, uint32_t before) {
        const uint32_t spare = spare_before(rows, before, need);
        state.segments[i].first = before + spare;
        state.segments[i].room = own + spare_before(rows, before + own, need) - spare;
      });
}

// All segments move; every block with an open subtree is to be written. After jumps, and where a
// list is nearly full: a step finds room among neighbours. Sets how they fit; returns how many
// places they take.
__device__ uint32_t move_segments(const StateView& state, SegmentFit& fit,
                                  BlockScan::TempStorage& storage) {
  for (fit = SegmentFit::roomy; fit != SegmentFit::none;
       fit = static_cast<SegmentFit>(static_cast<uint32_t>(fit) + 1)) {
    const uint32_t need = set_places(state, fit, 0, 0, storage);
    if (whole_rows(need) > state.list_room) continue;
    if (fit != SegmentFit::rows) return need;
    const uint32_t rows = (state.list_room - need) / kRowPlaces;
    return set_places(state, fit, rows, need, storage) + rows * kRowPlaces;
  }
  return set_places(state, fit, 0, 0, storage);
}

// A list ends with a row: what no segment writes of it holds no node.
__device__ uint32_t end_row(const StateView& state, uint32_t places) {
  const uint32_t end = whole_rows(places);
  if (places + threadIdx.x < end) state.nodes[places + threadIdx.x] = kNoNode;
  return end;
}

// `list`: of blocks, those that are open.
__device__ uint32_t list_open(const StateView& state, BlockScan::TempStorage& storage,
                              uint32_t* list) {
  return scan(
      state.block_count, storage, [&](uint32_t b) { return state.open_counts[b] != 0 ? 1u : 0u; },
      [&](uint32_t b, uint32_t is_open, uint32_t before) {
        if (is_open != 0) list[before] = b;
      });
}

// Where each block's nodes go, which blocks are to be written, which are open, and the
// frame's counters.
__global__ void __launch_bounds__(kScanThreads) search_place(StateView state) {
  __shared__ BlockScan::TempStorage storage;
  __shared__ Outgrown outgrown;
  __shared__ Dirty dirty;
  __shared__ bool moves;
  FrameCounters &counting = *state.counting, &counted = *state.counted;
  uint32_t list_size = counted.list_size;
  SegmentFit fit = counted.fit;
  const bool open_changed = counting.open_blocks_changed != 0;
  if (threadIdx.x == 0) {
    outgrown.count = 0;
    dirty = {state.dirty, state.dirty_flags, counting.dirty_count};
  }
  __syncthreads();
  for (uint32_t i = threadIdx.x; i < dirty.count; i += kScanThreads)
    find_outgrown(state, state.blocks[state.dirty[i]], outgrown);
  __syncthreads();
  if (threadIdx.x < 32) {
    bool fits =
        outgrown.count == 0 || (fit <= SegmentFit::rows && outgrown.count <= Outgrown::kMost);
    for (uint32_t i = 0; fits && i < outgrown.count; ++i) {
      fits = make_room(state, fit, outgrown.segments[i], dirty);
      __syncwarp();
    }
    if (threadIdx.x == 0) moves = !fits;
  }
  __syncthreads();
  for (uint32_t i = threadIdx.x; i < dirty.count; i += kScanThreads)
    state.dirty_flags[state.dirty[i]] = 0;
  __syncthreads();
  if (moves) {
    list_size = end_row(state, move_segments(state, fit, storage));
    const uint32_t open = list_open(state, storage, state.dirty);
    if (threadIdx.x == 0) dirty.count = fit == SegmentFit::none ? 0 : open;
  }
  if (open_changed) {
    const uint32_t open = list_open(state, storage, state.open_blocks);
    if (threadIdx.x == 0) *state.open_block_count = open;
  }
  __syncthreads();
  if (threadIdx.x == 0) {
    const uint32_t before = counted.cut_size, stand_ins = counted.stand_ins;
    counted = counting;
    counted.cut_size = static_cast<uint32_t>(before + counting.entered - counting.left);
    counted.stand_ins += stand_ins;
    counted.list_size = list_size;
    counted.fit = fit;
    counted.dirty_count = dirty.count;
    counting = FrameCounters{};
  }
}

}  // namespace

void launch_place(const SearchFrame& f) {
  launch_kernel("search_place", search_place, {1, kScanThreads, f.stream}, f.state);
}

}  // namespace voyager::cuda
