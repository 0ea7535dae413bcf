#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/search/cut_streaming.cuh"
#include "cuda/search/search_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 256;

__global__ void __launch_bounds__(kThreads)
    search_streaming(TreeView tree, StateView state, Sight sight, uint32_t reference) {
  Tally tally;
  stream_chunks(tree, state, sight, reference, tally);
  tally.flush(state.counting);
  if (blockIdx.x == 0 && threadIdx.x == 0) state.counting->streamed = 1;
}

}  // namespace

void launch_streaming(const SearchFrame& f) {
  const unsigned resident = resident_blocks<search_streaming, kThreads>();
  launch_kernel("search_streaming", search_streaming,
                {f.multiprocessors * resident, kThreads, f.stream}, f.tree, f.state, f.sight,
                f.reference);
}

}  // namespace voyager::cuda
