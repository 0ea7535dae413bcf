// From the state of a view to its cut list: node ids, ascending.
#include <algorithm>
#include <cub/block/block_scan.cuh>

#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/search/cut_lanes.cuh"
#include "cuda/search/search_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kEmitThreads = kBlockSubtrees;  // a subtree a lane
using LevelScan = cub::BlockScan<uint64_t, kEmitThreads, cub::BLOCK_SCAN_WARP_SCANS>;

// Counts of the three levels in one word: at most 1024 · 31 each.
constexpr unsigned kCountBits = 20;

__device__ uint64_t count_levels(uint32_t cut, uint32_t levels) {
  uint64_t counts = 0;
  for (unsigned level = 0; level < kLevels; ++level)
    counts |= uint64_t{static_cast<uint32_t>(__popc(cut & level_slots(level, levels)))}
              << (kCountBits * level);
  return counts;
}

// Places of a subtree's first cut node of each level.
struct Places {
  uint32_t of[kLevels];
};

// By a lane alone. parent: the record of the slot's parent.
template <bool kOrigin>
__device__ void put_node(const TreeView& tree, const StateView& state, const SearchSubtree& s,
                         uint32_t slot, uint32_t place, uint32_t parent) {
  const uint32_t node = s.node(slot);
  state.nodes[place] = node;
  if (state.ids != nullptr)
    state.ids[place] = tree.slot_ids[node / tree.slot_nodes].id(node % tree.slot_nodes);
  if (kOrigin)
    state.origin[place] = {s.interior >> slot & 1 ? record_of(tree, s, slot) : kNoRecord, parent};
}

template <bool kOrigin>
__device__ void emit_subtree(const TreeView& tree, const StateView& state, const SearchSubtree& s,
                             uint32_t cut, const Places& places) {
  const auto put = [&](uint32_t slots, uint32_t of_level, uint32_t first_place, uint32_t parent) {
    for (; slots != 0; slots &= slots - 1) {
      const uint32_t slot = __ffs(slots) - 1;
      put_node<kOrigin>(tree, state, s, slot, first_place + __popc(of_level & ((1u << slot) - 1)),
                        parent);
    }
  };
  put(cut & s.level_slots(0), cut & s.level_slots(0), places.of[0], s.entry);
  for (unsigned level = 1; level < kLevels; ++level) {
    const uint32_t nodes = cut & s.level_slots(level);
    if (nodes == 0) continue;
    uint32_t parents = s.interior & s.level_slots(level - 1);
    if (!kOrigin || (level == 1 && s.first_child_slot() == 1)) {
      put(nodes, nodes, places.of[level], s.first_record);
      parents = 0;
    }
    // Each parent knows its slots.
    for (; parents != 0; parents &= parents - 1) {
      const uint32_t record = record_of(tree, s, __ffs(parents) - 1);
      put(nodes & load_record(tree.records + record).child_slots(), nodes, places.of[level],
          record);
    }
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
  __shared__ LevelScan::TempStorage storage;
  const uint32_t dirty = state.counted->dirty_count;
  for (uint32_t i = blockIdx.x; i < dirty; i += gridDim.x) {
    const Block block = state.blocks[state.dirty[i]];
    const uint32_t subtree = block.first + threadIdx.x;
    const uint32_t cut = subtree < block.last ? state.cut[subtree] : 0;
    const SearchSubtree s = cut == 0 ? kUnlinkedSubtree : load_own_subtree(tree, subtree);
    uint64_t before;
    LevelScan(storage).ExclusiveSum(count_levels(cut, s.levels), before);
    Places places;
    for (unsigned level = 0; level < kLevels; ++level)
      places.of[level] = state.segments[block.first_segment + level * block.stride].first +
                         static_cast<uint32_t>(before >> (kCountBits * level) & 0xfffff);
    emit_subtree<kOrigin>(tree, state, s, cut, places);
    clear_rest(state, block);
    __syncthreads();
  }
}

}  // namespace

void launch_emit(const SearchFrame& f, bool weights) {
  const auto kernel = weights ? search_emit<true> : search_emit<false>;
  const unsigned resident = resident_blocks<search_emit<true>>(kEmitThreads);
  launch_kernel(
      "search_emit", kernel,
      {std::min(f.state.block_count, f.multiprocessors * resident), kEmitThreads, f.stream}, f.tree,
      f.state);
}

}  // namespace voyager::cuda
