// Before a search of a streamed scene: what linking has changed in the tree since the view's
// last cut.
#include <algorithm>

#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/search/cut_visit.cuh"
#include "cuda/search/search_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 256;

// A subtree that was open and to which nothing leads now is closed; so is all below it, which
// was unlinked with it. One that was linked again meanwhile is what it was, at other addresses.
// A subtree may be there more than once: what has set its word to 0 closes it.
__device__ void follow_unlinked(const TreeView& tree, const StateView& state, uint32_t subtree,
                                Tally& tally) {
  const uint32_t place = state.places(subtree);
  if (tree.subtrees[place].entry != kNotLinked) {
    if (lane_in_group() == 0 && (state.refined[place] & kOpen) != 0)
      mark_dirty(state, block_of(state, subtree));
    return;
  }
  const unsigned group = 0xffu << (kGroupLanes * group_in_warp());
  const uint32_t cut = state.cut[place];
  __syncwarp(group);
  uint32_t refined = 0;
  if (lane_in_group() == 0) refined = atomicExch(&state.refined[place], 0);
  refined = __shfl_sync(group, refined, 0, kGroupLanes);
  close_subtree(state, subtree, tree.subtrees[place].levels, {place, refined, cut}, tally);
}

// A record that is blocked now, or no longer is, changes its subtree's verdicts, however little
// has moved. Nothing that is closed here is linked.
__device__ void follow_changed(const TreeView& tree, const StateView& state, uint32_t subtree) {
  const uint32_t place = state.places(subtree);
  if (tree.subtrees[place].entry == kNotLinked || (state.refined[place] & kOpen) == 0) return;
  state.watch[place] = {-1.0f, 0};
  wake_row(state, subtree);
}

__global__ void __launch_bounds__(kThreads)
    search_relink(TreeView tree, StateView state, Relinked relinked) {
  Tally tally;
  const uint32_t thread = blockIdx.x * kThreads + threadIdx.x, threads = gridDim.x * kThreads;
  for (uint32_t i = thread / kGroupLanes; i < relinked.unlinked_count; i += threads / kGroupLanes)
    follow_unlinked(tree, state, relinked.unlinked[i], tally);
  for (uint32_t i = thread; i < relinked.changed_count; i += threads)
    follow_changed(tree, state, relinked.changed[i]);
  __syncwarp();
  tally.flush(state.counting);
}

// As CutState is made: the list is made anew with its segments.
__global__ void __launch_bounds__(kThreads) search_forget(StateView state) {
  const uint32_t thread = blockIdx.x * kThreads + threadIdx.x, threads = gridDim.x * kThreads;
  for (uint32_t i = thread; i < state.place_count; i += threads) {
    state.watch[i] = {INFINITY, 0};
    state.refined[i] = state.cut[i] = state.stand_ins[i] = 0;
  }
  for (uint32_t b = thread; b < state.block_count; b += threads)
    state.open_counts[b] = state.dirty_flags[b] = 0;
  const uint32_t rows = state.block_count * kBlockRows;
  for (uint32_t i = thread; i < rows; i += threads) state.rows[i].way = 0;
  for (uint32_t i = thread; i < kLevels * state.block_count; i += threads)
    state.segments[i] = {0, 0, 0};
  if (thread != 0) return;
  *state.open_block_count = 0;
  *state.counting = *state.counted = FrameCounters{};
}

}  // namespace

void launch_relink(const SearchFrame& f, const Relinked& relinked) {
  const unsigned resident = resident_blocks<search_relink, kThreads>();
  const uint32_t threads = std::max(relinked.unlinked_count * kGroupLanes, relinked.changed_count);
  if (threads == 0) return;
  launch_kernel("search_relink", search_relink,
                {std::min((threads + kThreads - 1) / kThreads, f.multiprocessors * resident),
                 kThreads, f.stream},
                f.tree, f.state, relinked);
}

void launch_forget(const SearchFrame& f) {
  const unsigned resident = resident_blocks<search_forget, kThreads>();
  launch_kernel("search_forget", search_forget, {f.multiprocessors * resident, kThreads, f.stream},
                f.state);
}

}  // namespace voyager::cuda
