// A tile's list once more, for how much light reaches each splat: a warp has a part of eight by
// four pixels, a lane a pixel. Only in frames that are to tell, so that the kernels of rasterize.cu
// know nothing of it. Exponentials are those of ex2 whatever the frame's are, and nothing limits
// depth: what is told decides the order of reads alone.
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/splat/raster_part.cuh"
#include "cuda/splat/shown.h"
#include "runtime/math/nth_bit.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kWarps = kTile * kTile / 32;

// The rank of a splat: in the last row whose first slot is not behind its own. Rows beyond the room
// have no splats.
__device__ uint32_t rank_of(const SplatView& splats, uint32_t slot) {
  const uint32_t places = min(splats.counters->places, splats.places);
  uint32_t first = 0, count = (places + kRowPlaces - 1) / kRowPlaces;
  while (count > 1) {
    const uint32_t half = count / 2;
    const bool behind = splats.ranks[first + half].first_slot <= slot;
    first += behind ? half : 0;
    count = behind ? count - half : half;
  }
  const RankRow row = splats.ranks[first];
  return first * kRowPlaces + nth_bit(row.candidates, slot - row.first_slot);
}

__device__ void note(const ShownFrame& f, uint32_t slot, uint8_t* by_slot) {
  const InstanceCounters* const of = f.splats.counters->instances;
  const uint32_t of_eye = slot % f.splats.slots;
  uint32_t k = 0;
  while (k + 1 < f.count && of_eye >= of[k + 1].first_slot) ++k;
  const ShownInstance& instance = f.instances[k];
  if (instance.nodes == nullptr) return;
  const uint32_t place = rank_of(f.splats, of_eye) - of[k].first_rank;
  const uint32_t node = __ldg(instance.nodes + place);
  by_slot[instance.first_slot + node / instance.slot_nodes] = 1;
}

// A lane's splat, as all of its warp have it.
__device__ float4 from_lane(const float4& own, int lane) {
  return {__shfl_sync(kAllLanes, own.x, lane), __shfl_sync(kAllLanes, own.y, lane),
          __shfl_sync(kAllLanes, own.z, lane), __shfl_sync(kAllLanes, own.w, lane)};
}

// A lane's pixel.
struct Light {
  float x, y;
  float left;  // the transmittance; 0 outside the image

  // Whether enough of it reaches the splat, which takes its share.
  __device__ bool meets(const ShownFrame& f, const float4& shape, const float4& middle,
                        float inverse_k) {
    float minus_log[1];
    lane_logarithms(x, y, 0.0f, shape, middle, minus_log);
    if (!(minus_log[0] <= -f.least_log)) return false;
    const bool met = left >= kAlphaThreshold;
    const float alpha = fminf(ex2(-minus_log[0] * f.to_base_2), kAlphaMax);
    const float blended =
        blended_alpha<Exponential::ex2, Siblings::few>(alpha, middle.w, inverse_k);
    left = fmaf(-blended, left, left);
    return met;
  }
};

__global__ void __launch_bounds__(32 * kWarps) mark_shown(const __grid_constant__ ShownFrame f) {
  const SplatView& splats = f.splats;
  const uint32_t tile = splats.tile_order[blockIdx.x];
  const TileList list = splats.tiles[tile];
  const uint32_t eye = splats.frame.eye(tile), of_eye = tile - splats.frame.first[eye];
  const auto columns = static_cast<uint32_t>(splats.frame.grids[eye].columns);
  const unsigned self = lane_in_warp(), warp = threadIdx.x / 32;
  const uint32_t left = of_eye % columns * kTile + warp % 2 * kPartWidth;
  const uint32_t top = of_eye / columns * kTile + warp / 2 * kLaneRows;
  const uint32_t x = left + self % kPartWidth, y = top + self / kPartWidth;
  const auto centre = [](uint32_t pixel) { return static_cast<float>(pixel) + 0.5f; };
  const Part part{centre(left), centre(left + kPartWidth - 1), centre(top),
                  centre(top + kLaneRows - 1)};
  Light light{centre(x), centre(y), x < f.width[eye] && y < f.height[eye] ? 1.0f : 0.0f};
  for (uint32_t first = list.first; first < list.last; first += 32) {
    const bool valid = first + self < list.last;
    const uint32_t slot = valid ? slot_of(splats.keys[first + self]) : 0;
    if (valid && warp == 0) note(f, slot, f.drawn);
    if (!__any_sync(kAllLanes, light.left >= kAlphaThreshold)) {
      if (warp != 0) return;
      continue;  // the first warp tells of all that is drawn
    }
    RasterSplat splat{};
    if (valid) {
      const auto* record = reinterpret_cast<const float4*>(splats.records + slot);
      splat = {__ldg(record), __ldg(record + 1), __ldg(record + 2)};
    }
    unsigned left_lanes =
        __ballot_sync(kAllLanes, valid && rasterize_touches(splat, part, f.least_log));
    bool shown = false;
    for (; left_lanes != 0; left_lanes &= left_lanes - 1) {
      const int lane = __ffs(static_cast<int>(left_lanes)) - 1;
      const bool met = light.meets(f, from_lane(splat.shape, lane), from_lane(splat.middle, lane),
                                   __shfl_sync(kAllLanes, splat.colour.w, lane));
      const bool any = __any_sync(kAllLanes, met);
      shown = shown || (any && self == static_cast<unsigned>(lane));
    }
    if (shown) note(f, slot, f.shown);
  }
}

}  // namespace

void launch_shown(const ShownFrame& frame, cudaStream_t stream) {
  if (frame.splats.frame.count() == 0) return;
  launch_kernel("mark_shown", mark_shown, {frame.splats.frame.count(), 32 * kWarps, stream}, frame);
}

}  // namespace voyager::cuda
