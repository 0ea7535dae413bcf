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

// Of a subtree, in shared memory: what a warp writes of one level.
struct LevelNodes {
  uint32_t place;  // of the first, less that of the warp's first
  uint32_t cut;    // slots of the level
};

// The nodes of a level that the warp's subtrees have in the cut, one a lane, so that what is
// written lies together. By lane: subtrees, level_of. total: of all lanes.
__device__ void emit_level(const StateView& state, const SearchSubtree* subtrees,
                           const LevelNodes* level_of, uint32_t first_place, uint32_t total) {
  for (uint32_t k = lane_in_warp(); k < total; k += 32) {
    uint32_t lane = 0;  // the last whose place is not beyond k: it has nodes
#pragma unroll
    for (unsigned step = 16; step != 0; step /= 2)
      if (level_of[lane + step].place <= k) lane += step;
    const uint32_t slot = nth_bit(level_of[lane].cut, k - level_of[lane].place);
    state.nodes[first_place + k] = subtrees[lane].node(slot);
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
__global__ void __launch_bounds__(kEmitThreads) search_emit(TreeView tree, StateView state) {
  __shared__ LevelScan::TempStorage storage;
  __shared__ SearchSubtree subtrees[kEmitThreads];
  __shared__ LevelNodes levels[kEmitThreads];
  const unsigned warp = threadIdx.x / 32 * 32;
  const uint32_t dirty = state.counted->dirty_count;
  for (uint32_t i = blockIdx.x; i < dirty; i += gridDim.x) {
    const Block block = state.blocks[state.dirty[i]];
    const uint32_t subtree = block.first + threadIdx.x;
    const uint32_t place = subtree < block.last ? state.places(subtree) : 0;
    const uint32_t cut = subtree < block.last ? state.cut[place] : 0;
    const SearchSubtree s = cut == 0 ? kUnlinkedSubtree : load_own_subtree(tree, place);
    subtrees[threadIdx.x] = s;
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
      levels[threadIdx.x] = {own - warps, cut & s.level_slots(level)};
      __syncwarp();
      emit_level(state, subtrees + warp, levels + warp,
                 state.segments[block.first_segment + level * block.stride].first + warps, total);
    }
    clear_rest(state, block);
    __syncthreads();
  }
}

}  // namespace

void launch_emit(const SearchFrame& f) {
  const unsigned resident = resident_blocks<search_emit, kEmitThreads>();
  launch_kernel(
      "search_emit", search_emit,
      {std::min(f.state.block_count, f.multiprocessors * resident), kEmitThreads, f.stream}, f.tree,
      f.state);
}

}  // namespace voyager::cuda
