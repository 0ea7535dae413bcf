// Between finding a cut and writing it down: where each block's nodes go in the list, which
// blocks are to be written, and the frame's counters.
#include "cuda/device/launch.cuh"
#include "cuda/search/search_launch.h"
#include "cuda/search/segment_room.cuh"

namespace voyager::cuda {
namespace {

// Marks a block's segments that have no room for their nodes; whether there are any.
__device__ bool mark_outgrown(const StateView& state, const Block& block,
                              RoomAmongNeighbours& room) {
  bool any = false;
  for (uint32_t level = 0; level < kLevels; ++level) {
    const uint32_t i = block.first_segment + level * block.stride;
    if (state.segments[i].size <= state.segments[i].room) continue;
    room.mark(i);
    any = true;
  }
  return any;
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
  __shared__ RoomAmongNeighbours room;
  __shared__ Dirty dirty;
  FrameCounters &counting = *state.counting, &counted = *state.counted;
  uint32_t list_size = counted.list_size;
  SegmentFit fit = counted.fit;
  const bool open_changed = counting.open_blocks_changed != 0;
  room.begin(state, fit);
  if (threadIdx.x == 0) dirty = {state.dirty, state.dirty_flags, counting.dirty_count};
  __syncthreads();
  bool outgrown = false;
  for (uint32_t i = threadIdx.x; i < dirty.count; i += kScanThreads)
    outgrown |= mark_outgrown(state, state.blocks[state.dirty[i]], room);
  outgrown = __syncthreads_or(outgrown) != 0;
  // A list without places has none to share.
  const bool moves =
      outgrown && (list_size == 0 || fit > SegmentFit::rows || !room.make(state, storage, dirty));
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
