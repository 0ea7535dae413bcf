#pragma once
// Subtrees on the device: eight lanes each, four to a warp. Every function here is
// called by all 32 lanes together; `active` tells which groups have a subtree.
#include "cuda/device/warp.cuh"
#include "cuda/search/cut_state.h"

namespace voyager::cuda {

inline constexpr unsigned kGroupLanes = 8, kGroups = 4;
inline constexpr unsigned kSlotRounds = 4;  // 32 slots over 8 lanes

__device__ inline unsigned lane_in_group() {
  return threadIdx.x % kGroupLanes;
}
__device__ inline unsigned group_in_warp() {
  return lane_in_warp() / kGroupLanes;
}

__device__ inline uint32_t group_or(uint32_t v) {
  for (unsigned step = kGroupLanes / 2; step != 0; step /= 2)
    v |= __shfl_xor_sync(kAllLanes, v, step, kGroupLanes);
  return v;
}
__device__ inline float group_min(float v) {
  for (unsigned step = kGroupLanes / 2; step != 0; step /= 2)
    v = fminf(v, __shfl_xor_sync(kAllLanes, v, step, kGroupLanes));
  return v;
}
__device__ inline float group_max(float v) {
  for (unsigned step = kGroupLanes / 2; step != 0; step /= 2)
    v = fmaxf(v, __shfl_xor_sync(kAllLanes, v, step, kGroupLanes));
  return v;
}
__device__ inline SearchRecord load_record(const SearchRecord* record) {
  const uint4 words = __ldg(reinterpret_cast<const uint4*>(record));
  return {words.x, {words.y, words.z, words.w}};
}

// One word a lane: 32 bytes in one request.
__device__ inline SearchSubtree load_subtree(const TreeView& tree, uint32_t place) {
  const uint32_t word =
      __ldg(reinterpret_cast<const uint32_t*>(tree.subtrees + place) + lane_in_group());
  SearchSubtree s;
  s.root = __shfl_sync(kAllLanes, word, 0, kGroupLanes);
  s.first_child = __shfl_sync(kAllLanes, word, 1, kGroupLanes);
  s.first_grandchild = __shfl_sync(kAllLanes, word, 2, kGroupLanes);
  s.levels = __shfl_sync(kAllLanes, word, 3, kGroupLanes);
  s.first_record = __shfl_sync(kAllLanes, word, 4, kGroupLanes);
  s.interior = __shfl_sync(kAllLanes, word, 5, kGroupLanes);
  s.families = __shfl_sync(kAllLanes, word, 6, kGroupLanes);
  s.entry = __shfl_sync(kAllLanes, word, 7, kGroupLanes);
  return s;
}

// The record of an interior slot.
__device__ inline uint32_t record_of(const TreeView& tree, const SearchSubtree& s, uint32_t slot) {
  return s.record(__popc(s.interior & slots_before(slot)), tree.next_block);
}

__device__ inline uint32_t block_of(const StateView& state, uint32_t subtree) {
  uint32_t low = 0, high = state.tier_count;  // the tier is in [low, high)
  while (high - low > 1) {
    const uint32_t middle = (low + high) / 2;
    if (state.tiers[middle].begin <= subtree)
      low = middle;
    else
      high = middle;
  }
  const Tier tier = state.tiers[low];
  return tier.first_block + (subtree - tier.begin) / kBlockSubtrees;
}

// The row of a subtree that gets another watch is to be looked at in the next frame.
__device__ inline void wake_row(const StateView& state, uint32_t subtree) {
  const uint32_t b = block_of(state, subtree);
  const uint32_t row = (subtree - state.blocks[b].first) / kRowSubtrees;
  state.rows[b * kBlockRows + row].way = 0;
}

// Of a visited subtree, besides its records: what it is and what was known of it.
inline constexpr uint32_t kVisitBytes =
    sizeof(SearchSubtree) + sizeof(Watch) + 2 * sizeof(uint32_t);

// What one warp has counted; a lane's part of it.
struct Tally {
  uint32_t tested = 0, visited = 0, hulls = 0, chunks = 0, entered = 0, left = 0;
  uint32_t stand_ins = 0;  // what they have changed by, modulo 2^32

  __device__ void flush(FrameCounters* counters) const {
    add(&counters->nodes_tested, tested + hulls);
    add(&counters->subtrees_visited, visited);
    add(&counters->chunks_read, chunks);
    add(&counters->bytes_read,
        tested * sizeof(SearchRecord) + visited * kVisitBytes + hulls * sizeof(SearchChunk));
    add(&counters->entered, entered);
    add(&counters->left, left);
    add(&counters->stand_ins, stand_ins);
  }

 private:
  template <class T>
  __device__ static void add(T* total, uint32_t part) {
    const uint32_t sum = __reduce_add_sync(kAllLanes, part);
    if (lane_in_warp() == 0 && sum != 0) atomicAdd(total, T{sum});
  }
};

// Whether the record that leads to a subtree is refined; nothing leads to the tree's root.
__device__ inline bool is_reached(const TreeView& tree, const SearchSubtree& s, const Sight& sight,
                                  Tally& tally) {
  if (s.entry == kNoRecord || s.entry == kNotLinked) return s.entry == kNoRecord;
  if (lane_in_group() == 0) ++tally.tested;
  return judge(load_record(tree.records + s.entry).bounds(), sight).refined;
}

// A subtree's verdicts; the same in all lanes of its group. Nodes below one that is not
// refined are tested too: they are not refined, and have more slack than it has.
__device__ inline Visit visit_group(const TreeView& tree, const SearchSubtree& s,
                                    const Sight& sight, bool active, Tally& tally) {
  Visit v;
  uint32_t reached = 0;
  const uint32_t interior = active ? s.interior : 0;
#pragma unroll
  for (unsigned round = 0; round < kSlotRounds; ++round) {
    if (!__any_sync(kAllLanes, (interior >> (kGroupLanes * round)) != 0)) break;
    const uint32_t slot = kGroupLanes * round + lane_in_group();
    bool refined = false;
    if (interior >> slot & 1) {
      const SearchRecord r = load_record(tree.records + record_of(tree, s, slot));
      const NodeBounds bounds = r.bounds();
      const NodeVerdict verdict = judge(bounds, sight);
      const bool blocked = r.children == kBlocked;
      refined = verdict.refined && !blocked;
      if (refined) reached |= r.child_slots();
      if (verdict.refined && blocked) v.stand_ins |= 1u << slot;
      v.slack = fminf(v.slack, verdict.slack);
      if (slot < s.first_child_slot()) v.extent = fmaxf(v.extent, bounds.extent);
      ++tally.tested;
    }
    const uint32_t votes = __ballot_sync(kAllLanes, refined);
    v.refined |= (votes >> (kGroupLanes * group_in_warp()) & 0xff) << (kGroupLanes * round);
  }
  reached = group_or(reached) | s.level_slots(0);
  v.slack = group_min(v.slack);
  v.extent = group_max(v.extent);  // the roots': extents never grow downwards
  v.cut = reached & ~v.refined & s.owned();
  // A record that is blocked is of the tier's lowest level: nodes below it are in no slot here.
  if (tree.streamed()) v.stand_ins = group_or(v.stand_ins) & v.cut;
  return v;
}

// The block's nodes are to be written again.
__device__ inline void mark_dirty(const StateView& state, uint32_t block) {
  if (state.dirty_flags[block] == 0 && atomicExch(&state.dirty_flags[block], 1) == 0)
    state.dirty[atomicAdd(&state.counting->dirty_count, 1)] = block;
}

// By one lane of a subtree's group.
__device__ inline void set_stand_ins(const StateView& state, uint32_t place, uint32_t slots,
                                     Tally& tally) {
  if (state.stand_ins == nullptr) return;
  const uint32_t before = state.stand_ins[place], now = __popc(slots);
  if (before == now) return;
  state.stand_ins[place] = static_cast<uint8_t>(now);
  tally.stand_ins += now - before;
}

// Nodes that entered and left: the sizes of the block's segments, and that they are to
// be written again.
__device__ inline void count_change(const StateView& state, uint32_t subtree, uint32_t levels,
                                    uint32_t old_cut, uint32_t new_cut, int opened, Tally& tally) {
  const uint32_t b = block_of(state, subtree);
  if (lane_in_group() < kLevels) {
    const uint32_t level = level_slots(lane_in_group(), levels);
    const int delta = __popc(new_cut & level) - __popc(old_cut & level);
    const Block& block = state.blocks[b];
    Segment& segment = state.segments[block.first_segment + lane_in_group() * block.stride];
    if (delta != 0) atomicAdd(&segment.size, static_cast<uint32_t>(delta));
  }
  if (lane_in_group() == kLevels && opened != 0) {
    const uint32_t before = atomicAdd(&state.open_counts[b], static_cast<uint32_t>(opened));
    if (before == (opened > 0 ? 0 : 1)) state.counting->open_blocks_changed = 1;
  }
  if (lane_in_group() == kLevels + 1 && new_cut != old_cut) mark_dirty(state, b);
  if (lane_in_group() == 0) {
    tally.entered += __popc(new_cut & ~old_cut);
    tally.left += __popc(old_cut & ~new_cut);
  }
}

// What was known of a subtree: loaded early, so that it is there when it is needed.
struct Known {
  uint32_t place = 0;  // the subtree's
  uint32_t refined = 0, cut = 0;
};
__device__ inline Known load_known(const StateView& state, uint32_t subtree) {
  const uint32_t place = state.places(subtree);
  return {place, state.refined[place], state.cut[place]};
}

// By a lane alone: what is known of a subtree from now on, of an open one and of a closed one.
__device__ inline void keep_open(const StateView& state, uint32_t subtree, const Known& known,
                                 const Visit& v, uint32_t reference, Tally& tally) {
  state.watch[known.place] = make_watch(v.slack, v.extent, reference);
  wake_row(state, subtree);
  if (v.refined != known.refined) state.refined[known.place] = v.refined;
  if (v.cut != known.cut) state.cut[known.place] = v.cut;
  set_stand_ins(state, known.place, v.stand_ins, tally);
  ++tally.visited;
}
__device__ inline void keep_closed(const StateView& state, uint32_t place, Tally& tally) {
  state.watch[place] = make_watch(INFINITY, 0.0f, 0);
  state.refined[place] = 0;
  state.cut[place] = 0;
  set_stand_ins(state, place, 0, tally);
}

// An open subtree takes its new verdicts.
__device__ inline void settle(const StateView& state, const SearchSubtree& s, uint32_t subtree,
                              const Known& known, const Visit& v, uint32_t reference, bool active,
                              Tally& tally) {
  __syncwarp();  // `known` was read by all lanes before one writes
  if (!active) return;
  const bool was_open = (known.refined & kOpen) != 0;
  if (lane_in_group() == 0) keep_open(state, subtree, known, v, reference, tally);
  if (v.cut != known.cut || !was_open)
    count_change(state, subtree, s.levels, known.cut, v.cut, was_open ? 0 : 1, tally);
}

// Also for one that is closed. Called by whole groups.
__device__ inline void close_subtree(const StateView& state, uint32_t subtree, uint32_t levels,
                                     const Known& known, Tally& tally) {
  if ((known.refined & kOpen) == 0) return;
  if (lane_in_group() == 0) keep_closed(state, known.place, tally);
  count_change(state, subtree, levels, known.cut, 0, -1, tally);
}

}  // namespace voyager::cuda
