// The exhaustive search: every node is tested and the cut compacted in one pass, the
// baseline of the others. Scratch and results are the caller's.
#include <thrust/iterator/counting_iterator.h>
#include <cub/device/device_select.cuh>

#include "cuda/device/launch.cuh"
#include "cuda/search/search_launch.h"
#include "runtime/math/lerp.h"

namespace voyager::cuda {
namespace {

__device__ NodeRecord load_node(const NodeRecord* record) {
  const float4* words = reinterpret_cast<const float4*>(record);
  const float4 a = __ldg(words), b = __ldg(words + 1);
  return {{a.x, a.y, a.z}, a.w, {b.x, b.y, b.z}, __float_as_uint(b.w)};
}

__device__ float node_size(const NodeRecord& r, const Sight& sight) {
  return screen_size(sight.centre, r.box_min, r.box_max, r.extent);
}

struct InCut {
  ExhaustiveTree tree;
  Sight sight;

  // Without a branch, so that the loads of a thread's items overlap.
  __device__ bool operator()(uint32_t node) const {
    const uint32_t parent = __ldg(tree.parent + node);
    const bool is_root = parent == kNoNode;
    const NodeRecord own = load_node(tree.records + node);
    const NodeRecord above = load_node(tree.records + (is_root ? node : parent));
    const bool refined = (node_size(own, sight) >= sight.target_size) & (own.child_count != 0);
    const bool reached = is_root | (node_size(above, sight) >= sight.target_size);
    return reached & !refined;
  }
};

__global__ void __launch_bounds__(256)
    search_weights(ExhaustiveTree tree, Sight sight, const uint32_t* nodes, const uint32_t* count,
                   float* weights) {
  const uint32_t n = *count;
  for (uint32_t i = blockIdx.x * blockDim.x + threadIdx.x; i < n; i += gridDim.x * blockDim.x) {
    const uint32_t node = nodes[i], parent = __ldg(tree.parent + node);
    const bool has_parent = parent != kNoNode;
    const float parent_size =
        has_parent ? node_size(load_node(tree.records + parent), sight) : 0.0f;
    weights[i] = interpolation_weight(has_parent, parent_size,
                                      node_size(load_node(tree.records + node), sight),
                                      sight.target_size, tree.blend_share);
  }
}

}  // namespace

size_t exhaustive_scratch_bytes(const ExhaustiveTree& tree) {
  size_t bytes = 0;
  check(cub::DeviceSelect::If(nullptr, bytes, thrust::counting_iterator<uint32_t>(0),
                              static_cast<uint32_t*>(nullptr), static_cast<uint32_t*>(nullptr),
                              tree.size, InCut{tree, {}}),
        "scratch of search_exhaustive");
  return bytes;
}

void launch_exhaustive(const ExhaustiveTree& tree, const Sight& sight, void* scratch,
                       size_t scratch_bytes, uint32_t* nodes, uint32_t* count,
                       cudaStream_t stream) {
  check(cub::DeviceSelect::If(scratch, scratch_bytes, thrust::counting_iterator<uint32_t>(0), nodes,
                              count, tree.size, InCut{tree, sight}, stream),
        "search_exhaustive");
}

void launch_weights(const ExhaustiveTree& tree, const Sight& sight, const uint32_t* nodes,
                    const uint32_t* count, float* weights, unsigned multiprocessors,
                    cudaStream_t stream) {
  launch_kernel("search_weights", search_weights, {multiprocessors * 8, 256, stream}, tree, sight,
                nodes, count, weights);
}

}  // namespace voyager::cuda
