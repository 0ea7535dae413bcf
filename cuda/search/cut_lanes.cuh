#pragma once
// Subtrees on the device, one a lane: where there are many, most of them small. Every function
// here is called by all 32 lanes together, unless it says otherwise.
#include "cuda/search/cut_visit.cuh"

namespace voyager::cuda {

// By a lane alone.
__device__ inline SearchSubtree load_own_subtree(const TreeView& tree, uint32_t subtree) {
  const uint4* words = reinterpret_cast<const uint4*>(tree.subtrees + subtree);
  const uint4 a = __ldg(words), b = __ldg(words + 1);
  return {a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w};
}

// is_reached(), by a lane alone.
__device__ inline bool is_own_reached(const TreeView& tree, const SearchSubtree& s,
                                      const Sight& sight, Tally& tally) {
  if (s.entry == kNoRecord || s.entry == kNotLinked) return s.entry == kNoRecord;
  ++tally.tested;
  return judge(load_record(tree.records + s.entry), sight).refined;
}

// By a lane alone.
__device__ inline Visit visit_own(const TreeView& tree, const SearchSubtree& s, const Sight& sight,
                                  Tally& tally) {
  Visit v = visit(s, sight, [&](uint32_t i) {
    return load_record(tree.records + s.record(i, tree.next_block));
  });
  v.stand_ins &= v.cut;
  tally.tested += v.tested;
  return v;
}

// How a lane's subtree has changed.
struct Change {
  bool any = false;
  uint32_t old_cut = 0, new_cut = 0;
  int opened = 0;  // 1: it is open now, and was not; -1: the other way
};

// count_change() of 32 subtrees. Neighbours are of the same block, so that few lanes add for all.
__device__ inline void count_changes(const StateView& state, uint32_t subtree, uint32_t levels,
                                     const Change& change, Tally& tally) {
  const uint32_t own_block = change.any ? block_of(state, subtree) : 0;
  for (uint32_t left = __ballot_sync(kAllLanes, change.any); left != 0;) {
    const unsigned leader = __ffs(left) - 1;
    const uint32_t b = __shfl_sync(kAllLanes, own_block, leader);
    const bool mine = change.any && own_block == b;
    const uint32_t old_cut = mine ? change.old_cut : 0, new_cut = mine ? change.new_cut : 0;
    const Block& block = state.blocks[b];
    for (uint32_t level = 0; level < kLevels; ++level) {
      const uint32_t slots = level_slots(level, levels);
      const int delta =
          __reduce_add_sync(kAllLanes, __popc(new_cut & slots) - __popc(old_cut & slots));
      if (lane_in_warp() == level && delta != 0)
        atomicAdd(&state.segments[block.first_segment + level * block.stride].size,
                  static_cast<uint32_t>(delta));
    }
    const int opened = __reduce_add_sync(kAllLanes, mine ? change.opened : 0);
    if (lane_in_warp() == kLevels && opened != 0) {
      const uint32_t before = atomicAdd(&state.open_counts[b], static_cast<uint32_t>(opened));
      if (before == 0 || before + static_cast<uint32_t>(opened) == 0)
        state.counting->open_blocks_changed = 1;
    }
    const bool moved = __any_sync(kAllLanes, old_cut != new_cut);
    if (lane_in_warp() == kLevels + 1 && moved) mark_dirty(state, b);
    left &= ~__ballot_sync(kAllLanes, mine);
  }
  if (!change.any) return;
  tally.entered += __popc(change.new_cut & ~change.old_cut);
  tally.left += __popc(change.old_cut & ~change.new_cut);
}

// By a lane alone: an open subtree takes its new verdicts.
__device__ inline Change settle_own(const StateView& state, uint32_t subtree, const Known& known,
                                    const Visit& v, uint32_t reference, Tally& tally) {
  const bool was_open = (known.refined & kOpen) != 0;
  keep_open(state, subtree, known, v, reference, tally);
  return {v.cut != known.cut || !was_open, known.cut, v.cut, was_open ? 0 : 1};
}

// By a lane alone; also for one that is closed.
__device__ inline Change close_own(const StateView& state, uint32_t subtree, const Known& known,
                                   Tally& tally) {
  if ((known.refined & kOpen) == 0) return {};
  keep_closed(state, subtree, tally);
  return {true, known.cut, 0, -1};
}

}  // namespace voyager::cuda
