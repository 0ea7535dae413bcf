// The sweep (METHOD §3 and §4, in two kernels): the size of every node that has children, in the
// order of ids; then the cut and its weights, of which those sizes are all that is needed.
#include <algorithm>

#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/search/search_launch.h"
#include "runtime/math/lerp.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 256;
// Words of nodes that a thread block collects at once: eight to each warp, one after another.
constexpr unsigned kTileWords = 64, kWarps = kThreads / 32, kWarpWords = kTileWords / kWarps;

__global__ void __launch_bounds__(kThreads)
    search_measure(SweepView tree, SweepState state, Sight sight) {
  const uint32_t first = blockIdx.x * kThreads + threadIdx.x;
  if (first == 0) *state.counters = {};
  for (uint32_t i = first; i < tree.records; i += gridDim.x * kThreads) {
    const float4 low = __ldg(tree.low + i);
    const Vec3f high{__ldg(&tree.high[i].x), __ldg(&tree.high[i].y), __ldg(&tree.high[i].z)};
    state.sizes[i] = screen_size(sight.centre, {low.x, low.y, low.z}, high, low.w);
  }
}

__device__ SweepWord load_word(const SweepWord* word) {
  const uint4 w = __ldg(reinterpret_cast<const uint4*>(word));
  return {w.x, w.y, w.z, w.w};
}

struct Verdict {
  bool in_cut;
  float weight;
};

// Whether the node of a word at a lane is in the cut, and its weight.
__device__ Verdict judge_node(const SweepView& tree, const SweepState& state, const Sight& sight,
                              uint32_t word, unsigned lane) {
  const uint32_t node = 32 * word + lane;
  const SweepWord w = load_word(tree.words + word);
  const uint32_t lower = (1u << lane) - 1;
  const bool there = node < tree.nodes, interior = w.interior >> lane & 1;
  const bool has_parent = there && node != 0;
  const uint32_t own = w.interior_before + __popc(w.interior & lower);
  // The last first child up to this node is of its own family.
  const uint32_t families = w.families_before + __popc(w.first_children & (lower << 1 | 1));
  const float size = interior ? state.sizes[own] : 0.0f;
  const float parent_size = has_parent ? state.sizes[families - 1] : 0.0f;
  const bool refined = interior && size >= sight.target_size;
  const bool reached = !has_parent || parent_size >= sight.target_size;
  return {there && reached && !refined,
          interpolation_weight(has_parent, parent_size, size, sight.target_size, tree.blend_share)};
}

// What a tile publishes of the cut nodes before its end: first those of its own, then all. The
// run's number tells them from those of the run before.
__device__ void publish(unsigned long long* tile, uint32_t run, bool all, uint32_t count) {
  const unsigned long long value =
      static_cast<unsigned long long>(2 * run + (all ? 1 : 0)) << 32 | count;
  *static_cast<volatile unsigned long long*>(tile) = value;
}

// Cut nodes in the tiles before this one; by a whole warp. Tiles are taken in order, so that those
// before have running blocks, and the wait ends.
__device__ uint32_t count_before(const unsigned long long* tiles, uint32_t run, uint32_t tile,
                                 unsigned lane) {
  uint32_t before = 0;
  for (int64_t end = tile; end > 0; end -= 32) {
    const int64_t other = end - 1 - lane;
    uint32_t status = 2 * run + 1, count = 0;  // before the first tile: nothing, and that is all
    if (other >= 0) {
      unsigned long long value;
      do {
        value = *static_cast<const volatile unsigned long long*>(tiles + other);
        status = static_cast<uint32_t>(value >> 32);
      } while (status >> 1 != (run & 0x7fffffffu));
      count = static_cast<uint32_t>(value);
    }
    const uint32_t complete = __ballot_sync(kAllLanes, (status & 1) != 0);
    const uint32_t needed = complete == 0 ? 32 : __ffs(complete);  // lanes up to the first of all
    before += __reduce_add_sync(kAllLanes, lane < needed ? count : 0);
    if (complete != 0) break;
  }
  return before;
}

// Places of the tile's words, from their counts; returns the tile's sum. By one warp.
__device__ uint32_t scan_words(uint32_t* counts, unsigned lane) {
  static_assert(kTileWords == 64);
  const uint32_t a = counts[2 * lane], b = counts[2 * lane + 1];
  const uint32_t sum = warp_scan(a + b);
  counts[2 * lane] = sum - a - b;
  counts[2 * lane + 1] = sum - b;
  return __shfl_sync(kAllLanes, sum, 31);
}

// Decoupled look-back: one pass over the nodes, in the order of ids.
__global__ void __launch_bounds__(kThreads)
    search_collect(SweepView tree, SweepState state, Sight sight, uint32_t run) {
  __shared__ uint32_t counts[kTileWords], taken, before;
  const unsigned lane = lane_in_warp(), warp = threadIdx.x / 32;
  const uint32_t words = (tree.nodes + 31) / 32, tiles = (words + kTileWords - 1) / kTileWords;
  uint32_t entered = 0, left = 0;
  for (;;) {
    if (threadIdx.x == 0) taken = atomicAdd(&state.counters->next_tile, 1);
    __syncthreads();
    const uint32_t tile = taken;
    if (tile >= tiles) break;
    Verdict verdicts[kWarpWords];
    uint32_t cut[kWarpWords];
#pragma unroll
    for (unsigned k = 0; k < kWarpWords; ++k) {
      const uint32_t word = tile * kTileWords + warp * kWarpWords + k;
      const bool there = word < words;
      verdicts[k] = there ? judge_node(tree, state, sight, word, lane) : Verdict{};
      cut[k] = __ballot_sync(kAllLanes, verdicts[k].in_cut);
      if (lane != 0) continue;
      counts[warp * kWarpWords + k] = __popc(cut[k]);
      if (!there) continue;
      const uint32_t held = state.cut[word];
      if (held != cut[k]) state.cut[word] = cut[k];
      entered += __popc(cut[k] & ~held);
      left += __popc(held & ~cut[k]);
    }
    __syncthreads();
    if (warp == 0) {
      const uint32_t count = scan_words(counts, lane);
      if (tile != 0 && lane == 0) publish(state.tiles + tile, run, false, count);
      const uint32_t sum = count_before(state.tiles, run, tile, lane);
      if (lane == 0) {
        publish(state.tiles + tile, run, true, sum + count);
        before = sum;
        if (tile + 1 == tiles) state.counters->cut_size = sum + count;
      }
    }
    __syncthreads();
#pragma unroll
    for (unsigned k = 0; k < kWarpWords; ++k) {
      if (!verdicts[k].in_cut) continue;
      const uint32_t place =
          before + counts[warp * kWarpWords + k] + __popc(cut[k] & ((1u << lane) - 1));
      state.nodes[place] = 32 * (tile * kTileWords + warp * kWarpWords + k) + lane;
      if (state.weights != nullptr) state.weights[place] = verdicts[k].weight;
    }
  }
  if (entered != 0) atomicAdd(&state.counters->entered, entered);
  if (left != 0) atomicAdd(&state.counters->left, left);
}

}  // namespace

size_t sweep_tiles(uint32_t nodes) {
  return (nodes + 32 * kTileWords - 1) / (32 * kTileWords);
}

void launch_sweep(const SweepView& tree, const SweepState& state, const Sight& sight, uint32_t run,
                  unsigned multiprocessors, cudaStream_t stream) {
  const unsigned measure_blocks = resident_blocks<search_measure, kThreads>();
  const unsigned collect_blocks = resident_blocks<search_collect, kThreads>();
  const uint32_t records = std::max(tree.records, 1u);
  launch_kernel("search_measure", search_measure,
                {std::min((records + kThreads - 1) / kThreads, multiprocessors * measure_blocks),
                 kThreads, stream},
                tree, state, sight);
  launch_kernel(
      "search_collect", search_collect,
      {std::min(static_cast<uint32_t>(sweep_tiles(tree.nodes)), multiprocessors * collect_blocks),
       kThreads, stream},
      tree, state, sight, run);
}

}  // namespace voyager::cuda
