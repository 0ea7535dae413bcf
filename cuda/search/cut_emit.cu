// From the state of a view to its cut list: node ids, ascending.
#include <algorithm>
#include <cub/block/block_scan.cuh>

#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/search/cut_lanes.cuh"
#include "cuda/search/search_launch.h"
#include "runtime/math/nth_bit.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kEmitThreads = kBlockSubtrees;  // a subtree a lane
using LevelScan = cub::BlockScan<uint64_t, kEmitThreads, cub::BLOCK_SCAN_WARP_SCANS>;

// Counts of the three levels in one word: at most kBlockSubtrees · 31 each.
constexpr unsigned kCountBits = 20;

__device__ uint64_t count_levels(uint32_t cut, uint32_t levels) {
  uint64_t counts = 0;
  for (unsigned level = 0; level < kLevels; ++level)
    counts |= uint64_t{static_cast<uint32_t>(__popc(cut & level_slots(level, levels)))}
              << (kCountBits * level);
  return counts;
}

// Of a subtree, in shared memory: what its warp needs for the nodes of one level.
struct LevelNodes {
  uint32_t place;  // of the first, less that of the warp's first
  uint32_t cut;    // slots of the level
  uint32_t base;   // the node of a slot, less the slot
  // Only for origins. above: on level 0 the entry's record, else the place of the first parent's
  // record among the subtree's.
  uint32_t interior, families, first_record, above;
};

__device__ LevelNodes level_nodes(const SearchSubtree& s, uint32_t cut, uint32_t level,
                                  uint32_t place) {
  const uint32_t slots = s.level_slots(level);
  return {place,
          cut & slots,
          s.first_node(level) - s.first_slot(level),
          s.interior,
          s.families & slots,
          s.first_record,
          level == 0   ? s.entry
          : level == 1 ? 0
                       : __popc(s.interior & s.level_slots(0))};
}

// A record's number, from its place among the subtree's.
__device__ uint32_t record_at(const TreeView& tree, const LevelNodes& nodes, bool scattered,
                              uint32_t k) {
  SearchSubtree s{};
  s.first_record = nodes.first_record;
  s.levels = scattered ? kScattered : 0;
  return s.record(k, tree.next_block);
}

// The nodes of a level that the warp's subtrees have in the cut, one a lane, so that what is
// written lies together. level_of: by lane. total: of all lanes.
template <bool kOrigin>
__device__ void emit_level(const TreeView& tree, const StateView& state, const LevelNodes* level_of,
                           uint32_t scattered, uint32_t level, uint32_t first_place,
                           uint32_t total) {
  for (uint32_t k = lane_in_warp(); k < total; k += 32) {
    uint32_t lane = 0;  // the last whose place is not beyond k: it has nodes
#pragma unroll
    for (unsigned step = 16; step != 0; step /= 2)
      if (level_of[lane + step].place <= k) lane += step;
    const LevelNodes& nodes = level_of[lane];
    const uint32_t slot = nth_bit(nodes.cut, k - nodes.place), node = nodes.base + slot;
    const uint32_t place = first_place + k;
    state.nodes[place] = node;
    if (!kOrigin) continue;
    const bool apart = (scattered >> lane & 1) != 0;
    const uint32_t own = __popc(nodes.interior & slots_before(slot));
    const uint32_t parent = nodes.above + __popc(nodes.families & slots_before(slot + 1)) - 1;
    state.origin[place] = {
        (nodes.interior >> slot & 1) != 0 ? record_at(tree, nodes, apart, own) : kNoRecord,
        level == 0 ? nodes.above : record_at(tree, nodes, apart, parent)};
  }
}

// Room that a segment does not use holds no node.
__device__ void clear_rest(const StateView& state, const Block& block) {
  for (uint32_t level = 0; level < kLevels; ++level) {
    const Segment segment = state.segments[block.first_segment + level * block.stride];
    for (uint32_t i = segment.size + threadIdx.x; i < segment.room; i += kEmitThreads)
      state.nodes[segment.first + i] = kNoNode;
  }
}

// The blocks in which nodes entered or left. Nothing else of the list moves.
template <bool kOrigin>
__global__ void __launch_bounds__(kEmitThreads) search_emit(TreeView tree, StateView state) {
  __shared__ LevelScan::TempStorage storage;
  __shared__ LevelNodes levels[kEmitThreads];
  LevelNodes* const own_warps = levels + threadIdx.x / 32 * 32;
  const uint32_t dirty = state.counted->dirty_count;
  for (uint32_t i = blockIdx.x; i < dirty; i += gridDim.x) {
    const Block block = state.blocks[state.dirty[i]];
    const uint32_t subtree = block.first + threadIdx.x;
    const uint32_t place = subtree < block.last ? state.places(subtree) : 0;
    const uint32_t cut = subtree < block.last ? state.cut[place] : 0;
    const SearchSubtree s = cut == 0 ? kUnlinkedSubtree : load_own_subtree(tree, place);
    const uint32_t scattered = __ballot_sync(kAllLanes, s.scattered());
    uint64_t before;
    LevelScan(storage).ExclusiveSum(count_levels(cut, s.levels), before);
    for (unsigned level = 0; level < kLevels; ++level) {
      const auto own =
          static_cast<uint32_t>(before >> (kCountBits * level)) & ((1u << kCountBits) - 1);
      const uint32_t count = __popc(cut & s.level_slots(level));
      const uint32_t warps = __shfl_sync(kAllLanes, own, 0);
      const uint32_t total = __shfl_sync(kAllLanes, own + count, 31) - warps;
      if (total == 0) continue;
      __syncwarp();
      own_warps[lane_in_warp()] = level_nodes(s, cut, level, own - warps);
      __syncwarp();
      emit_level<kOrigin>(tree, state, own_warps, scattered, level,
                          state.segments[block.first_segment + level * block.stride].first + warps,
                          total);
    }
    clear_rest(state, block);
    __syncthreads();
  }
}

}  // namespace

void launch_emit(const SearchFrame& f, bool origins) {
  const auto kernel = origins ? search_emit<true> : search_emit<false>;
  const unsigned resident = resident_blocks<search_emit<true>, kEmitThreads>();
  launch_kernel(
      "search_emit", kernel,
      {std::min(f.state.block_count, f.multiprocessors * resident), kEmitThreads, f.stream}, f.tree,
      f.state);
}

}  // namespace voyager::cuda
