// The bounds of a cut list's rows: of each row that search_emit has written.
#include <algorithm>

#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/scene/gaussian_hull.cuh"
#include "cuda/search/search_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 256;

// Numbers, not NaN, as integers that ascend with them: a warp finds the least of these at once.
__device__ uint32_t ascending(float v) {
  const uint32_t bits = __float_as_uint(v);
  return bits ^ (static_cast<uint32_t>(static_cast<int32_t>(bits) >> 31) | 0x80000000u);
}
__device__ float number_of(uint32_t ascending) {
  return __uint_as_float((ascending & 0x80000000u) != 0 ? ascending ^ 0x80000000u : ~ascending);
}
__device__ float warp_min(float v) {
  return number_of(__reduce_min_sync(kAllLanes, ascending(v)));
}
__device__ float warp_max(float v) {
  return number_of(__reduce_max_sync(kAllLanes, ascending(v)));
}

__device__ void add(MeanBounds& bounds, const GaussianHull& hull) {
  bounds.least = {fminf(bounds.least.x, hull.mean.x), fminf(bounds.least.y, hull.mean.y),
                  fminf(bounds.least.z, hull.mean.z)};
  bounds.greatest = {fmaxf(bounds.greatest.x, hull.mean.x), fmaxf(bounds.greatest.y, hull.mean.y),
                     fmaxf(bounds.greatest.z, hull.mean.z)};
  bounds.scale = fmaxf(bounds.scale, hull.max_scale);
  bounds.radius = fmaxf(bounds.radius, sqrtf(hull.radius_squared));
}

// A lane's part. A node between its parent and itself has its mean between the two.
__device__ MeanBounds bounds_of(const GaussianView& gaussians, uint32_t node, bool parents) {
  MeanBounds bounds{{INFINITY, INFINITY, INFINITY}, 0, {-INFINITY, -INFINITY, -INFINITY}, 0};
  if (node == kNoNode) return bounds;
  add(bounds, hull_at(gaussians, node));
  const uint32_t parent = parents ? gaussians.parents(node) : kNoNode;
  if (parent != kNoNode) add(bounds, hull_at(gaussians, parent));
  return bounds;
}

// Of a whole warp, in its first lane.
__device__ MeanBounds joined(const MeanBounds& own) {
  return {{warp_min(own.least.x), warp_min(own.least.y), warp_min(own.least.z)},
          warp_max(own.scale),
          {warp_max(own.greatest.x), warp_max(own.greatest.y), warp_max(own.greatest.z)},
          warp_max(own.radius)};
}

// Thread blocks that share a block of subtrees where few have changed: one alone would wait for
// memory row after row. After a jump all have, and each has enough to do.
constexpr uint32_t kShares = 8;

// A row a warp.
__global__ void __launch_bounds__(kThreads)
    search_bound(StateView state, GaussianView gaussians, bool parents) {
  constexpr uint32_t kWarps = kThreads / 32;
  const uint32_t dirty = state.counted->dirty_count, lane = lane_in_warp();
  const uint32_t shares = kShares * dirty <= gridDim.x ? kShares : 1;
  for (uint32_t i = blockIdx.x; i < shares * dirty; i += gridDim.x) {
    const Block block = state.blocks[state.dirty[i / shares]];
    const uint32_t first = i % shares * kWarps + threadIdx.x / 32;
    for (uint32_t level = 0; level < kLevels; ++level) {
      const Segment segment = state.segments[block.first_segment + level * block.stride];
      const uint32_t end = whole_rows(segment.first + segment.room) / kRowPlaces;
      for (uint32_t row = segment.first / kRowPlaces + first; row < end; row += shares * kWarps) {
        const MeanBounds bounds =
            joined(bounds_of(gaussians, state.nodes[row * kRowPlaces + lane], parents));
        if (lane == 0) state.bounds[row] = bounds;
      }
    }
  }
}

}  // namespace

void launch_bound(const StateView& state, const GaussianView& gaussians, bool weights,
                  unsigned multiprocessors, cudaStream_t stream) {
  const unsigned resident = resident_blocks<search_bound, kThreads>();
  launch_kernel(
      "search_bound", search_bound,
      {std::min(kShares * state.block_count, multiprocessors * resident), kThreads, stream}, state,
      gaussians, weights);
}

}  // namespace voyager::cuda
