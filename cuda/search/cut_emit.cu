// From the state of a view to its cut list: node ids, ascending.
#include <algorithm>
#include <cub/block/block_scan.cuh>

#include "cuda/device/grid.h"
#include "cuda/search/cut_visit.cuh"
#include "cuda/search/search_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kEmitThreads = 1024;
constexpr unsigned kItems = kBlockSubtrees / kEmitThreads;
constexpr unsigned kEmitGroups = kEmitThreads / kGroupLanes;
// Thread blocks that share a block's subtrees where so many would have nothing to do. Each counts
// all of them, so that it does not pay where all have enough.
constexpr uint32_t kShares = 4;
static_assert(kBlockSubtrees / kShares % kEmitGroups == 0);
using LevelScan = cub::BlockScan<uint64_t, kEmitThreads, cub::BLOCK_SCAN_WARP_SCANS>;

// Counts of the three levels in one word: at most 1024 · 31 each.
constexpr unsigned kCountBits = 20;

__device__ uint64_t count_levels(uint32_t cut, uint32_t child_count) {
  uint64_t counts = 0;
  for (unsigned level = 0; level < kLevels; ++level)
    counts |= uint64_t{static_cast<uint32_t>(__popc(cut & level_mask(level, child_count)))}
              << (kCountBits * level);
  return counts;
}

struct EmitShared {
  LevelScan::TempStorage storage;
  uint64_t before[kBlockSubtrees];  // cut nodes of the block's earlier subtrees, by level
  uint32_t cut[kBlockSubtrees];
};

__device__ void count_block(const TreeView& tree, const StateView& state, const Block& block,
                            EmitShared& shared) {
  uint64_t counts[kItems], before[kItems];
  for (unsigned k = 0; k < kItems; ++k) {
    const uint32_t i = threadIdx.x * kItems + k, subtree = block.first + i;
    const uint32_t cut = subtree < block.last ? state.cut[subtree] : 0;
    shared.cut[i] = cut;
    counts[k] = cut == 0 ? 0 : count_levels(cut, tree.subtrees[subtree].child_count);
  }
  LevelScan(shared.storage).ExclusiveSum(counts, before);
  for (unsigned k = 0; k < kItems; ++k) shared.before[threadIdx.x * kItems + k] = before[k];
  __syncthreads();
}

// Records of the parents of a lane's slots above the children's, by round.
struct Parents {
  uint32_t record[kSlotRounds];
};

__device__ void find_parents(const TreeView& tree, const SearchSubtree& s, uint32_t interior,
                             Parents& parents) {
  for (uint32_t& record : parents.record) record = s.first_record;  // the root's
  // Each interior child claims its slots.
  uint32_t left = interior & level_mask(1, s.child_count);
  while (__any_sync(kAllLanes, left != 0)) {
    const uint32_t record = left == 0 ? 0 : record_of(s, __ffs(left) - 1);
    const uint32_t slots = left == 0 ? 0 : __ldg(&tree.records[record].children);
#pragma unroll
    for (unsigned round = 0; round < kSlotRounds; ++round)
      if (slots >> (kGroupLanes * round + lane_in_group()) & 1) parents.record[round] = record;
    left &= left - 1;
  }
}

// Places of a subtree's first cut node of each level.
struct Places {
  uint32_t of[kLevels];
};

template <bool kOrigin>
__device__ void emit_subtree(const TreeView& tree, const StateView& state, const SearchSubtree& s,
                             uint32_t cut, const Places& places) {
  const uint32_t children = cut & level_mask(1, s.child_count);
  const uint32_t grandchildren = cut & level_mask(2, s.child_count);
  Parents parents;
  if (kOrigin) find_parents(tree, s, grandchildren == 0 ? 0 : s.interior, parents);
#pragma unroll
  for (unsigned round = 0; round < kSlotRounds; ++round) {
    const uint32_t slot = kGroupLanes * round + lane_in_group();
    if ((cut >> slot & 1) == 0) continue;
    const uint32_t lower = (1u << slot) - 1;
    uint32_t node = s.root, place = places.of[0], parent = s.entry;
    if (slot > s.child_count) {
      node = s.first_grandchild + (slot - 1 - s.child_count);
      place = places.of[2] + __popc(grandchildren & lower);
      parent = parents.record[round];
    } else if (slot != 0) {
      node = s.first_child + (slot - 1);
      place = places.of[1] + __popc(children & lower);
      parent = s.first_record;
    }
    state.nodes[place] = node;
    if (state.ids != nullptr) state.ids[place] = __ldg(tree.node_ids + node);
    if (kOrigin)
      state.origin[place] = {s.interior >> slot & 1 ? record_of(s, slot) : kNoRecord, parent};
  }
}

// Room that a segment does not use holds no node.
__device__ void clear_rest(const StateView& state, const Block& block) {
  for (uint32_t level = 0; level < kLevels; ++level) {
    const Segment segment = state.segments[block.first_segment + level * block.stride];
    for (uint32_t i = segment.size + threadIdx.x; i < segment.room; i += kEmitThreads) {
      state.nodes[segment.first + i] = kNoNode;
      if (state.ids != nullptr) state.ids[segment.first + i] = kNoNode;
    }
  }
}

// The blocks in which nodes entered or left. Nothing else of the list moves.
template <bool kOrigin>
__global__ void __launch_bounds__(kEmitThreads) search_emit(TreeView tree, StateView state) {
  __shared__ EmitShared shared;
  const uint32_t dirty = state.work[1].dirty_count;
  const uint32_t shares = kShares * dirty <= gridDim.x ? kShares : 1;
  for (uint32_t i = blockIdx.x; i < shares * dirty; i += gridDim.x) {
    const Block block = state.blocks[state.dirty[i / shares]];
    const uint32_t begin = i % shares * (kBlockSubtrees / shares);
    const uint32_t end = min(begin + kBlockSubtrees / shares, block.last - block.first);
    __syncthreads();
    count_block(tree, state, block, shared);
    uint32_t first[kLevels];
    for (unsigned level = 0; level < kLevels; ++level)
      first[level] = state.segments[block.first_segment + level * block.stride].first;
    for (uint32_t base = begin; base < end; base += kEmitGroups) {
      const uint32_t k = base + threadIdx.x / kGroupLanes;
      const uint32_t cut = shared.cut[k];
      if (!__any_sync(kAllLanes, cut != 0)) continue;
      const uint64_t before = shared.before[k];
      Places places;
      for (unsigned level = 0; level < kLevels; ++level)
        places.of[level] =
            first[level] + static_cast<uint32_t>(before >> (kCountBits * level) & 0xfffff);
      const SearchSubtree s = load_subtree(tree, min(block.first + k, block.last - 1));
      emit_subtree<kOrigin>(tree, state, s, cut, places);
    }
    if (begin == 0) clear_rest(state, block);
  }
}

}  // namespace

void launch_emit(const SearchFrame& f, bool weights) {
  const auto kernel = weights ? search_emit<true> : search_emit<false>;
  const unsigned resident = resident_blocks<search_emit<true>>(kEmitThreads);
  kernel<<<std::min(kShares * f.state.block_count, f.multiprocessors * resident), kEmitThreads, 0,
           f.stream>>>(f.tree, f.state);
  check(cudaGetLastError(), "search_emit");
}

}  // namespace voyager::cuda
