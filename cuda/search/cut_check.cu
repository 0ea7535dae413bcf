// Which open subtrees a temporal search visits: those whose slack has run out, or all.
#include <algorithm>

#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/search/cut_visit.cuh"
#include "cuda/search/search_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 256, kWarps = kThreads / 32;
static_assert(kBlockRows <= 32 && kRowSubtrees == 32);  // a row a lane, then a subtree a lane

// What a warp has found in a block, before it has places for it in due[].
struct Found {
  uint32_t* subtrees;  // room for a block's
  uint32_t count = 0;

  __device__ void add(bool is_one, uint32_t subtree) {
    const uint32_t votes = __ballot_sync(kAllLanes, is_one);
    if (is_one) subtrees[count + __popc(votes & ((1u << lane_in_warp()) - 1))] = subtree;
    count += __popc(votes);
  }

  __device__ void list(const StateView& state) {
    if (count == 0) return;
    __syncwarp();
    uint32_t place = 0;
    if (lane_in_warp() == 0) place = atomicAdd(&state.counting->due_count, count);
    place = __shfl_sync(kAllLanes, place, 0);
    for (uint32_t k = lane_in_warp(); k < count; k += 32)
      if (place + k < state.due_room) state.due[place + k] = subtrees[k];
    __syncwarp();
    count = 0;
  }
};

// A row a lane: a block's rows are few beside its subtrees, and most have nothing that is due.
__global__ void __launch_bounds__(kThreads)
    search_check(StateView state, Travels travels, Journey now, uint32_t reference) {
  __shared__ Travel travel[kReferences];
  __shared__ uint32_t found_subtrees[kWarps][kBlockSubtrees];
  static_assert(kThreads == kReferences);
  travel[threadIdx.x] = travels.of[threadIdx.x];
  __syncthreads();
  Found found{found_subtrees[threadIdx.x / 32]};
  uint32_t bytes = 0;
  const uint32_t open_blocks = *state.open_block_count;
  const uint32_t warps = gridDim.x * kWarps;
  for (uint32_t i = (blockIdx.x * kThreads + threadIdx.x) / 32; i < open_blocks; i += warps) {
    const uint32_t b = state.open_blocks[i];
    const Block block = state.blocks[b];
    WatchRow* rows = state.rows + b * kBlockRows;
    const bool there = block.first + lane_in_warp() * kRowSubtrees < block.last;
    const WatchRow own = there ? rows[lane_in_warp()] : WatchRow{};
    const bool ends = there && static_cast<int32_t>(own.moves - now.moves) <= 0;
    const uint32_t ending = __ballot_sync(kAllLanes, ends);
    uint32_t looks = __ballot_sync(kAllLanes, there && !is_quiet(own, now));
    bytes += kBlockRows * sizeof(WatchRow) + __popc(looks) * kRowSubtrees * sizeof(Watch);
    for (; looks != 0; looks &= looks - 1) {
      const uint32_t row = __ffs(looks) - 1;
      const uint32_t subtree = block.first + row * kRowSubtrees + lane_in_warp();
      Look left;
      if (subtree < block.last) {
        Watch& kept = state.watch[state.places(subtree)];
        const Watch before = kept;
        Watch watch = before;
        left = look_at(watch, travel, travels.retired, reference, ending >> row & 1);
        if (watch.extent_and_reference != before.extent_and_reference ||
            watch.slack != before.slack)
          kept = watch;
      }
      found.add(left.due, subtree);
      // Floats that are not negative are in the order of their bits.
      const uint32_t least = __reduce_min_sync(kAllLanes, __float_as_uint(fmaxf(left.slack, 0.0f)));
      const uint32_t moves = __reduce_min_sync(kAllLanes, left.moves);
      if (lane_in_warp() == 0)
        rows[row] = {__dadd_rd(now.way, double{__uint_as_float(least)}), now.turns,
                     now.moves + moves};
    }
    found.list(state);
  }
  if (lane_in_warp() == 0 && bytes != 0)
    atomicAdd(&state.counting->bytes_read, static_cast<unsigned long long>(bytes));
}

__global__ void __launch_bounds__(kThreads) search_list_open(StateView state) {
  __shared__ uint32_t found_subtrees[kWarps][kBlockSubtrees];
  Found found{found_subtrees[threadIdx.x / 32]};
  uint32_t bytes = 0;
  const uint32_t open_blocks = *state.open_block_count;
  const uint32_t warps = gridDim.x * kWarps;
  for (uint32_t i = (blockIdx.x * kThreads + threadIdx.x) / 32; i < open_blocks; i += warps) {
    const Block block = state.blocks[state.open_blocks[i]];
    for (uint32_t first = block.first; first < block.last; first += 32) {
      const uint32_t subtree = first + lane_in_warp();
      found.add(subtree < block.last && (state.refined[state.places(subtree)] & kOpen) != 0,
                subtree);
    }
    bytes += (block.last - block.first) * sizeof(uint32_t);
    found.list(state);
  }
  if (lane_in_warp() == 0 && bytes != 0)
    atomicAdd(&state.counting->bytes_read, static_cast<unsigned long long>(bytes));
}

uint32_t blocks_for(const SearchFrame& f, unsigned resident) {
  return std::min((f.state.block_count + kWarps - 1) / kWarps, f.multiprocessors * resident);
}

}  // namespace

void launch_check(const SearchFrame& f, const Travels& travels, const Journey& now) {
  launch_kernel("search_check", search_check,
                {blocks_for(f, resident_blocks<search_check, kThreads>()), kThreads, f.stream},
                f.state, travels, now, f.reference);
}

void launch_list_open(const SearchFrame& f) {
  launch_kernel("search_list_open", search_list_open,
                {blocks_for(f, resident_blocks<search_list_open, kThreads>()), kThreads, f.stream},
                f.state);
}

}  // namespace voyager::cuda
