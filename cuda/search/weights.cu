// The weights of all places of a cut list, for those who do not find them as they draw.
#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/search/cut_weight.cuh"
#include "cuda/search/search_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kWeightThreads = 256;

// Siblings are neighbours, and share their parent's record.
__global__ void __launch_bounds__(kWeightThreads)
    search_weigh(WeightSource from, const uint32_t* nodes, const FrameCounters* counted,
                 float* weights) {
  const uint32_t count = counted->list_size;
  for (uint32_t i = blockIdx.x * kWeightThreads + threadIdx.x; i < count;
       i += gridDim.x * kWeightThreads)
    if (nodes[i] != kNoNode) weights[i] = weight_of(from, nodes[i]);
}

}  // namespace

void launch_weigh(const WeightSource& from, const StateView& state, float* weights,
                  unsigned multiprocessors, cudaStream_t stream) {
  const unsigned resident = resident_blocks<search_weigh, kWeightThreads>();
  launch_kernel("search_weigh", search_weigh, {multiprocessors * resident, kWeightThreads, stream},
                from, state.nodes, state.counted, weights);
}

}  // namespace voyager::cuda
