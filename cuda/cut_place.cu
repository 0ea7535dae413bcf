// Between finding a cut and writing it down: where each block's nodes go in the list, which
// blocks are to be written, and the frame's counters.
#include <cub/block/block_scan.cuh>

#include "cuda/search_launch.h"

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

__device__ bool outgrown(const StateView& state, const Block& block) {
  bool any = false;
  for (uint32_t level = 0; level < kLevels; ++level) {
    const Segment& segment = state.segments[block.first_segment + level * block.stride];
    any |= segment.size > segment.room;
  }
  return any;
}

// New places for all segments, with new room; every block with an open subtree is to
// be written. Rare: one in eight of a segment's nodes must be new.
__device__ uint32_t move_segments(const StateView& state, BlockScan::TempStorage& storage) {
  return scan(
      kLevels * state.block_count, storage,
      [&](uint32_t i) { return segment_room(state.segments[i].size); },
      [&](uint32_t i, uint32_t room, uint32_t before) {
        state.segments[i].first = before;
        state.segments[i].room = room;
      });
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
  FrameCounters* work = state.work;
  uint32_t dirty = work[0].dirty_count, list_size = work[1].list_size;
  const bool open_changed = work[0].open_blocks_changed != 0;
  bool outgrew = false;
  for (uint32_t i = threadIdx.x; i < dirty; i += kScanThreads) {
    const uint32_t b = state.dirty[i];
    state.dirty_flags[b] = 0;
    outgrew |= outgrown(state, state.blocks[b]);
  }
  if (__syncthreads_or(outgrew)) {
    list_size = move_segments(state, storage);
    dirty = list_open(state, storage, state.dirty);
  }
  if (open_changed) {
    const uint32_t open = list_open(state, storage, state.open_blocks);
    if (threadIdx.x == 0) *state.open_block_count = open;
  }
  __syncthreads();
  if (threadIdx.x == 0) {
    const uint32_t before = work[1].cut_size, stand_ins = work[1].stand_ins;
    work[1] = work[0];
    work[1].cut_size = static_cast<uint32_t>(before + work[0].entered - work[0].left);
    work[1].stand_ins += stand_ins;
    work[1].list_size = list_size;
    work[1].dirty_count = dirty;
    work[0] = FrameCounters{};
  }
}

}  // namespace

void launch_place(const SearchFrame& f) {
  search_place<<<1, kScanThreads, 0, f.stream>>>(f.state);
  check(cudaGetLastError(), "search_place");
}

}  // namespace voyager::cuda
