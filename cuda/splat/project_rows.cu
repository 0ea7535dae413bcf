// METHOD §5, §7a for whole rows of a cut list: those of which a Gaussian may reach the image,
// and is not hidden.
#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/scene/gaussian_hull.cuh"
#include "cuda/splat/occlusion.cuh"
#include "cuda/splat/splat_launch.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 256;

template <bool kSecond>
__device__ bool row_may_reach(const SplatFrame& f, uint32_t row) {
  MeanBounds bounds = f.draws.list.bounds[row];
  bounds.radius = radius_above(bounds.radius * bounds.radius, f.params[0].log_threshold);
  bool reaches = false;
  for (uint32_t eye = 0; eye < f.splats.frame.eyes; ++eye)
    reaches = reaches || may_reach(f.params[eye], bounds);
  return reaches && !hidden_in_all<kSecond>(f.splats, f.params, bounds);
}

// A row a lane. Their order depends on scheduling; nothing that is made of them does. Those that
// are left out have no candidates.
template <bool kSecond>
__global__ void __launch_bounds__(kThreads) project_rows(SplatFrame f) {
  if (kSecond && !has_work(f.splats)) return;
  InstanceCounters* const counters = f.splats.counters->instances + f.instance;
  const uint32_t first_rank = min(counters->first_rank, f.splats.places);
  const uint32_t places = min(*f.draws.list.size, f.splats.places - first_rank);
  const uint32_t end = (places + kRowPlaces - 1) / kRowPlaces;
  const uint32_t lane = lane_in_warp();
  for (uint32_t base = blockIdx.x * kThreads + threadIdx.x - lane; base < end;
       base += gridDim.x * kThreads) {
    const uint32_t row = base + lane;
    const uint32_t found = __ballot_sync(kAllLanes, row < end && row_may_reach<kSecond>(f, row));
    uint32_t first = 0;
    if (lane == 0 && found != 0)
      first = atomicAdd(&counters->rows, static_cast<uint32_t>(__popc(found)));
    first = __shfl_sync(kAllLanes, first, 0);
    if (found >> lane & 1)
      f.splats.rows[first + __popc(found & ((1u << lane) - 1))] = row;
    else if (row < end)
      f.splats.ranks[first_rank / kRowPlaces + row].candidates = 0;
  }
}

template <bool kSecond>
void launch(const SplatFrame& f) {
  constexpr auto rows = project_rows<kSecond>;
  const unsigned resident = resident_blocks<rows, kThreads>();
  launch_kernel("project_rows", rows, {f.multiprocessors * resident, kThreads, f.stream}, f);
}

}  // namespace

RowList launch_rows(const SplatFrame& f) {
  if (f.draws.list.bounds == nullptr || f.draws.list.room == 0) return {};
  if (f.splats.open_parts == nullptr)
    launch<false>(f);
  else
    launch<true>(f);
  return {f.splats.rows, &f.splats.counters->instances[f.instance].rows};
}

}  // namespace voyager::cuda
