#pragma once
// Subtrees on the device, one a lane: where there are many, most of them small. Every function
// here is called by all 32 lanes together, unless it says otherwise.
#include "cuda/device/warp.cuh"
#include "cuda/search/cut_visit.cuh"

namespace voyager::cuda {

// By a lane alone.
__device__ inline SearchSubtree load_own_subtree(const TreeView& tree, uint32_t place) {
  const uint4* words = reinterpret_cast<const uint4*>(tree.subtrees + place);
  const uint4 a = __ldg(words), b = __ldg(words + 1);
  return {a.x, a.y, a.z, a.w, b.x, b.y, b.z, b.w};
}

// is_reached(), by a lane alone.
__device__ inline bool is_own_reached(const TreeView& tree, const SearchSubtree& s,
                                      const Sight& sight, Tally& tally) {
  if (s.entry == kNoRecord || s.entry == kNotLinked) return s.entry == kNoRecord;
  ++tally.tested;
  return judge(load_record(tree.records + s.entry).bounds(), sight).refined;
}

// What judging a subtree's records found: bits by record, in their order.
struct Judged {
  uint32_t refined = 0, blocked = 0;
  float slack = INFINITY, extent = 0.0f;
};

// The records of 32 subtrees, one a lane, since few subtrees have as many as others: lanes would
// wait for one of theirs that has many. Those below a node that is not refined are judged too: they
// are not refined, and have more slack than it has.
__device__ inline Judged judge_records(const TreeView& tree, const SearchSubtree& s, bool active,
                                       const Sight& sight, Tally& tally) {
  const uint32_t lane = lane_in_warp(), own = active ? __popc(s.interior) : 0;
  const uint32_t through = warp_scan(own);
  const uint32_t start = through - own, total = __shfl_sync(kAllLanes, through, 31);
  const uint32_t own_roots = __popc(s.interior & s.level_slots(0));
  Judged all;
  for (uint32_t base = 0; base < total; base += 32) {
    uint32_t of = 0;  // the lane whose record this is: the last that starts here or before
#pragma unroll
    for (unsigned step = 16; step != 0; step /= 2)
      if (__shfl_sync(kAllLanes, start, of + step) <= base + lane) of += step;
    SearchSubtree owner{};
    owner.first_record = __shfl_sync(kAllLanes, s.first_record, of);
    owner.levels = __shfl_sync(kAllLanes, s.levels, of);
    const uint32_t k = base + lane - __shfl_sync(kAllLanes, start, of);
    const bool is_root = k < __shfl_sync(kAllLanes, own_roots, of);
    bool refined = false, blocked = false;
    float slack = INFINITY, extent = 0.0f;
    if (base + lane < total) {
      const SearchRecord r = load_record(tree.records + owner.record(k, tree.next_block));
      const NodeBounds bounds = r.bounds();
      const NodeVerdict verdict = judge(bounds, sight);
      refined = verdict.refined, blocked = r.children == kBlocked, slack = verdict.slack;
      if (is_root) extent = bounds.extent;
    }
    const uint32_t refined_votes = __ballot_sync(kAllLanes, refined);
    const uint32_t blocked_votes = __ballot_sync(kAllLanes, blocked);
    // Over the lanes of one subtree, in the first of them.
#pragma unroll
    for (unsigned step = 1; step < 32; step *= 2) {
      const uint32_t other = __shfl_down_sync(kAllLanes, of, step);
      const float other_slack = __shfl_down_sync(kAllLanes, slack, step);
      const float other_extent = __shfl_down_sync(kAllLanes, extent, step);
      if (lane + step >= 32 || other != of) continue;
      slack = fminf(slack, other_slack), extent = fmaxf(extent, other_extent);
    }
    const uint32_t from = max(start, base), to = min(start + own, base + 32);
    const float own_slack = __shfl_sync(kAllLanes, slack, from % 32);
    const float own_extent = __shfl_sync(kAllLanes, extent, from % 32);
    if (from >= to) continue;
    const uint32_t mask = slots_before(to - from);
    all.refined |= (refined_votes >> (from - base) & mask) << (from - start);
    all.blocked |= (blocked_votes >> (from - base) & mask) << (from - start);
    all.slack = fminf(all.slack, own_slack), all.extent = fmaxf(all.extent, own_extent);
  }
  tally.tested += own;
  return all;
}

// The slots of those of a level whose parents are refined. refined: bits of the parents in turn.
__device__ inline uint32_t children_of_refined(const SearchSubtree& s, uint32_t level,
                                               uint32_t refined) {
  const uint32_t slots = s.level_slots(level) & slots_before(s.slot_count());
  uint32_t reached = 0;
  for (uint32_t starts = s.families & slots; starts != 0; refined >>= 1) {
    const uint32_t first = starts & (~starts + 1);
    starts &= starts - 1;
    const uint32_t next = starts & (~starts + 1);  // 0: the level's end
    if (refined & 1) reached |= slots & ~(first - 1) & (next - 1);
  }
  return reached;
}

// A subtree a lane.
__device__ inline Visit visit_lanes(const TreeView& tree, const SearchSubtree& s, bool active,
                                    const Sight& sight, Tally& tally) {
  const Judged judged = judge_records(tree, s, active, sight, tally);
  const uint32_t refined = judged.refined & ~judged.blocked;
  Visit v;
  v.slack = judged.slack, v.extent = judged.extent;
  uint32_t by_record = refined, waits = judged.refined & judged.blocked;
  for (uint32_t left = s.interior; (by_record | waits) != 0; left &= left - 1) {
    const uint32_t slot = left & (~left + 1);
    if (by_record & 1) v.refined |= slot;
    if (waits & 1) v.stand_ins |= slot;
    by_record >>= 1, waits >>= 1;
  }
  const uint32_t roots = s.level_slots(0);
  const uint32_t reached = roots | children_of_refined(s, 1, refined) |
                           children_of_refined(s, 2, refined >> __popc(s.interior & roots));
  v.cut = reached & ~v.refined & s.owned();
  v.stand_ins &= v.cut;
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
__device__ inline Change close_own(const StateView& state, const Known& known, Tally& tally) {
  if ((known.refined & kOpen) == 0) return {};
  keep_closed(state, known.place, tally);
  return {true, known.cut, 0, -1};
}

}  // namespace voyager::cuda
