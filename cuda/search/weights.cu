// The weights of a cut list (METHOD §4).
#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/search/cut_visit.cuh"
#include "cuda/search/search_launch.h"
#include "runtime/math/lerp.h"

namespace voyager::cuda {
namespace {

__device__ float record_size(const TreeView& tree, uint32_t record, const Sight& sight) {
  const SearchRecord r = load_record(tree.records + record);
  return screen_size(sight.centre, r.box_min, r.box_max, r.extent);
}

__device__ float own_size(const TreeView& tree, uint32_t record, uint32_t node,
                          const Sight& sight) {
  if (record != kNoRecord) return record_size(tree, record, sight);
  if (tree.leaves == nullptr) return 0.0f;
  const NodeRecord& leaf = tree.leaves[node];
  return screen_size(sight.centre, leaf.box_min, leaf.box_max, leaf.extent);
}

constexpr unsigned kWeightThreads = 256;

// A row a warp: siblings are neighbours, and share their parent's record.
__global__ void __launch_bounds__(kWeightThreads)
    search_weigh(TreeView tree, StateView state, Sight sight, RowList rows) {
  static_assert(kRowPlaces == 32);
  const uint32_t all = state.counted->list_size / kRowPlaces;
  const uint32_t count = rows.rows == nullptr ? all : *rows.count;
  const uint32_t warps = gridDim.x * kWeightThreads / 32;
  for (uint32_t k = (blockIdx.x * kWeightThreads + threadIdx.x) / 32; k < count; k += warps) {
    const uint32_t row = rows.rows == nullptr ? k : rows.rows[k];
    const uint32_t i = row * kRowPlaces + threadIdx.x % 32;
    const uint32_t node = state.nodes[i];
    if (node == kNoNode) continue;
    const CutOrigin origin = state.origin[i];
    const bool has_parent = origin.parent != kNoRecord;
    const float parent = has_parent ? record_size(tree, origin.parent, sight) : 0.0f;
    state.weights[i] =
        interpolation_weight(has_parent, parent, own_size(tree, origin.own, node, sight),
                             sight.target_size, tree.blend_share);
  }
}

}  // namespace

void launch_weigh(const SearchFrame& f, const RowList& rows) {
  const unsigned resident = resident_blocks<search_weigh>(kWeightThreads);
  launch_kernel("search_weigh", search_weigh,
                {f.multiprocessors * resident, kWeightThreads, f.stream}, f.tree, f.state, f.sight,
                rows);
}

}  // namespace voyager::cuda
