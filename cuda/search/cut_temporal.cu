// The temporal search (METHOD §9) of what cut_check.cu has listed: visit, descend. Where too much
// has run out of slack, the last of the two streams instead.
#include <algorithm>

#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/search/cut_streaming.cuh"
#include "cuda/search/search_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 256;

__device__ bool falls_back(const StateView& state, uint32_t max_due) {
  return state.counting->due_count > max_due;
}

__device__ void send_signals(const StateView& state, uint32_t first, uint32_t last, uint32_t kind) {
  const uint32_t place = atomicAdd(&state.counting->signal_tail, last - first);
  for (uint32_t i = first; i < last; ++i) atomicExch(&state.signals[place + (i - first)], i | kind);
}

// BOTTOM for the subtrees below a node that became refined; for those below one that
// no longer is, the end: their parent's subtree answers for that part again (TOP).
__device__ void signal_change(const TreeView& tree, const StateView& state, const SearchSubtree& s,
                              uint32_t slot, uint32_t refined) {
  const uint32_t record = record_of(tree, s, slot);
  const auto [first, last] = subtrees_below(tree.subtrees, tree.places, tree.subtree_count, record,
                                            __ldg(&tree.records[record].children));
  if (first != last) send_signals(state, first, last, refined >> slot & 1 ? 0 : kClose);
}

// By the lanes of a group, which share the slots out.
__device__ void signal_changes(const TreeView& tree, const StateView& state, const SearchSubtree& s,
                               uint32_t old_refined, uint32_t refined) {
  for (uint32_t left = (old_refined ^ refined) & s.interior; left != 0; left &= left - 1) {
    const uint32_t slot = __ffs(left) - 1;
    if (slot % kGroupLanes == lane_in_group()) signal_change(tree, state, s, slot, refined);
  }
}

// Of a subtree that is due. One that nothing reaches any more closes at once, before its parent,
// which is due too, says so: what changed would enter the cut only to leave it again, and count as
// both.
__device__ void visit_due_groups(const TreeView& tree, const StateView& state, const Sight& sight,
                                 uint32_t reference, uint32_t count, Tally& tally) {
  const uint32_t warp = (blockIdx.x * kThreads + threadIdx.x) / 32;
  const uint32_t warps = gridDim.x * kThreads / 32;
  for (uint32_t base = warp * kGroups; base < count; base += warps * kGroups) {
    const bool active = base + group_in_warp() < count;
    const uint32_t subtree = state.due[active ? base + group_in_warp() : base];
    const Known known = load_known(state, subtree);
    const SearchSubtree s = load_subtree(tree, known.place);
    const Visit v = visit_group(tree, s, sight, active, tally);
    const bool open = active && (v.cut == known.cut || is_reached(tree, s, sight, tally));
    settle(state, s, subtree, known, v, reference, open, tally);
    if (active) signal_changes(tree, state, s, known.refined, v.refined);
    if (active && !open) close_subtree(state, subtree, s.levels, known, tally);
  }
}

// The same, a subtree a lane.
__device__ void visit_due_lanes(const TreeView& tree, const StateView& state, const Sight& sight,
                                uint32_t reference, uint32_t count, Tally& tally) {
  const uint32_t first = (blockIdx.x * kThreads + threadIdx.x) / 32 * 32;
  for (uint32_t base = first; base < count; base += gridDim.x * kThreads) {
    const bool there = base + lane_in_warp() < count;
    const uint32_t subtree = state.due[there ? base + lane_in_warp() : base];
    const Known known = load_known(state, subtree);
    const SearchSubtree s = load_own_subtree(tree, known.place);
    const Visit v = visit_lanes(tree, s, there, sight, tally);
    Change change;
    if (there) {
      const bool open = v.cut == known.cut || is_own_reached(tree, s, sight, tally);
      change = open ? settle_own(state, subtree, known, v, reference, tally)
                    : close_own(state, known, tally);
      for (uint32_t left = (known.refined ^ v.refined) & s.interior; left != 0; left &= left - 1)
        signal_change(tree, state, s, __ffs(left) - 1, v.refined);
    }
    count_changes(state, subtree, s.levels, change, tally);
  }
}

__global__ void __launch_bounds__(kThreads)
    search_visit(TreeView tree, StateView state, Sight sight, uint32_t reference,
                 uint32_t max_due) {
  if (falls_back(state, max_due)) return;
  Tally tally;
  const uint32_t count = state.counting->due_count;
  // Eight lanes end a subtree sooner than one; where there is a subtree for each lane, they are
  // mostly idle.
  if (count < gridDim.x * kThreads)
    visit_due_groups(tree, state, sight, reference, count, tally);
  else
    visit_due_lanes(tree, state, sight, reference, count, tally);
  tally.flush(state.counting);
}

__device__ uint32_t read_now(const uint32_t* counter) {
  return *static_cast<const volatile uint32_t*>(counter);
}

// Done when as many signals are answered as were sent: `done` is read first, so that
// it can only be too small.
__device__ bool all_answered(const FrameCounters* counting) {
  bool all = false;
  if (lane_in_warp() == 0) {
    const uint32_t done = read_now(&counting->signals_done);
    __threadfence();
    all = done == read_now(&counting->signal_tail);
  }
  return __shfl_sync(kAllLanes, all, 0);
}

// The signal of a ticket, or kNoSignal where it has not come yet. A group that waits
// for one must not hold up the others of its warp.
__device__ uint32_t take_signal(const StateView& state, uint32_t ticket) {
  if (ticket >= read_now(&state.counting->signal_tail)) return kNoSignal;
  return atomicExch(&state.signals[ticket], kNoSignal);
}

// A subtree that opens may send more signals before its own counts as answered.
__device__ void answer(const TreeView& tree, const StateView& state, const Sight& sight,
                       uint32_t reference, uint32_t signal, Tally& tally) {
  const bool any = signal != kNoSignal;
  const bool opens = any && (signal & kClose) == 0;
  const uint32_t subtree = any ? signal & ~kClose : 0;
  const Known known = load_known(state, subtree);
  const SearchSubtree s = load_subtree(tree, known.place);
  const Visit v = visit_group(tree, s, sight, opens, tally);
  settle(state, s, subtree, known, v, reference, opens, tally);
  if (opens) signal_changes(tree, state, s, 0, v.refined);
  if (any && !opens) close_subtree(state, subtree, s.levels, known, tally);
  __threadfence();
  __syncwarp();
  if (any && lane_in_group() == 0) atomicAdd(&state.counting->signals_done, 1);
}

__device__ void answer_signals(const TreeView& tree, const StateView& state, const Sight& sight,
                               uint32_t reference, Tally& tally) {
  bool holds_ticket = false;
  uint32_t ticket = 0;
  while (!all_answered(state.counting)) {
    uint32_t signal = kNoSignal;
    if (lane_in_group() == 0) {
      if (!holds_ticket) ticket = atomicAdd(&state.counting->signal_head, 1);
      signal = take_signal(state, ticket);
      holds_ticket = signal == kNoSignal;
    }
    signal = __shfl_sync(kAllLanes, signal, 0, kGroupLanes);
    if (__any_sync(kAllLanes, signal != kNoSignal))
      answer(tree, state, sight, reference, signal, tally);
    else
      __nanosleep(200);
  }
}

// As many thread blocks as there is work for: those that wait only get in the way. A block answers
// 32 signals at once, and the first few blocks begin before there are any.
__device__ bool helps(const FrameCounters* counting) {
  constexpr uint32_t kLeast = 4, kSignalsEach = 32;
  uint32_t sent = 0;
  if (lane_in_warp() == 0) sent = read_now(&counting->signal_tail);
  sent = __shfl_sync(kAllLanes, sent, 0);  // a warp's lanes stay together
  return blockIdx.x < kLeast + sent / kSignalsEach;
}

__global__ void __launch_bounds__(kThreads)
    search_descend(TreeView tree, StateView state, Sight sight, uint32_t reference,
                   uint32_t max_due) {
  Tally tally;
  if (falls_back(state, max_due)) {
    stream_chunks(tree, state, sight, reference, tally);
    if (blockIdx.x == 0 && threadIdx.x == 0) state.counting->streamed = 1;
  } else if (helps(state.counting)) {
    answer_signals(tree, state, sight, reference, tally);
  }
  tally.flush(state.counting);
}

}  // namespace

void launch_temporal(const SearchFrame& f, uint32_t max_due) {
  const unsigned visit_blocks = resident_blocks<search_visit, kThreads>();
  const unsigned descend_blocks = resident_blocks<search_descend, kThreads>();
  launch_kernel("search_visit", search_visit,
                {f.multiprocessors * visit_blocks, kThreads, f.stream}, f.tree, f.state, f.sight,
                f.reference, max_due);
  launch_kernel("search_descend", search_descend,
                {f.multiprocessors * descend_blocks, kThreads, f.stream}, f.tree, f.state, f.sight,
                f.reference, max_due);
}

}  // namespace voyager::cuda
