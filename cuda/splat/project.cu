// METHOD §5–7, §12: the Gaussians of a frame to splats. project_cull reads the hulls of the rows
// that may reach the image, where the search keeps bounds of them, weighs their nodes, and lists
// those that may reach the image; project_splats reads the rest of these.
#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/scene/device_arrays.cuh"
#include "cuda/scene/gaussian_hull.cuh"
#include "cuda/search/cut_weight.cuh"
#include "cuda/splat/draw_item.cuh"
#include "cuda/splat/occlusion.cuh"
#include "cuda/splat/splat_launch.h"
#include "cuda/splat/tile_strips.cuh"

namespace voyager::cuda {
namespace {

// A lane asks for the hulls of its places together, so that it waits for memory once.
constexpr unsigned kCullThreads = 256, kCullItems = 4;
constexpr unsigned kProjectThreads = 128;  // small blocks: registers bound how many are resident
// Blocks that a multiprocessor must hold with two eyes. Without this bound the compiler uses more
// registers, which costs more than a few spills.
constexpr unsigned kPairBlocks = 6;

// Whether any eye may see the item if nothing hides it. hull: its Gaussian's.
template <bool kLod, int kEyes, bool kSecond>
__device__ bool project_may_show(const SplatFrame& f, const DrawItem& item, GaussianHull hull) {
  if (item.gaussian == kNoNode) return false;
  if (kLod && item.t != 1.0f) {
    const GaussianHull parent = hull_at(f.gaussians, item.parent);
    hull = {lerp_rn(parent.mean, hull.mean, item.t), fmaxf(parent.max_scale, hull.max_scale),
            fmaxf(parent.radius_squared, hull.radius_squared)};
  }
  if (!is_inside(f.params[0].clip, hull.mean)) return false;
  const float radius = radius_above(hull.radius_squared, f.params[0].log_threshold);
  bool reaches = false;
  for (int eye = 0; eye < kEyes; ++eye)
    reaches = reaches || may_reach(f.params[eye], hull.mean, hull.max_scale, radius);
  return radius > 0.0f && reaches &&
         !hidden_in_all<kSecond>(f.splats, f.params,
                                 {hull.mean, hull.max_scale, hull.mean, radius});
}

// What the place of a node draws, and `t` of the node where it is found here.
template <bool kLod>
__device__ DrawItem weighed_item(const SplatFrame& f, uint32_t place, uint32_t node, float& t) {
  const WeightSource& from = f.draws.weights;
  if (!kLod || node == kNoNode) return {node, kNoNode, 1.0f, 1.0f};
  const float weight =
      from.origin == nullptr ? __ldg(f.draws.list.weights + place) : weight_of(from, place, node);
  if (from.origin != nullptr) t = weight;
  return item_of(f.gaussians, node, weight);
}

// Lists the places of a block's threads that have a bit in their warp's `lanes`, in order within
// each warp, from *next on. `found` and `first` are the block's.
template <unsigned kItems, class Put>
__device__ void append_places(const uint32_t (&lanes)[kItems], uint32_t* next, uint32_t& found,
                              uint32_t& first, const Put& put) {
  const uint32_t lane = lane_in_warp();
  __syncthreads();  // the last call's have been read
  if (threadIdx.x == 0) found = 0;
  __syncthreads();
  uint32_t before[kItems];
#pragma unroll
  for (unsigned k = 0; k < kItems; ++k)
    if (lane == 0) before[k] = atomicAdd(&found, static_cast<uint32_t>(__popc(lanes[k])));
  __syncthreads();
  if (threadIdx.x == 0) first = atomicAdd(next, found);
  __syncthreads();
#pragma unroll
  for (unsigned k = 0; k < kItems; ++k) {
    const uint32_t at = first + __shfl_sync(kAllLanes, before[k], 0);
    if (lanes[k] >> lane & 1) put(at + __popc(lanes[k] & ((1u << lane) - 1)), k);
  }
}

// The order of the candidates depends on scheduling; nothing that is made of them does. Those that
// blend with their parents are apart: restoring two Gaussians takes twice as long, and a warp takes
// as long as its slowest.
template <bool kLod, int kEyes, bool kSecond>
__global__ void __launch_bounds__(kCullThreads) project_cull(SplatFrame f) {
  if (kSecond && !has_work(f.splats)) return;
  __shared__ uint32_t found, first;
  const uint32_t places = *f.draws.list.size;
  InstanceCounters* const counters = f.splats.counters->instances + f.instance;
  const uint32_t first_place = counters->first_place;
  if (blockIdx.x == 0 && threadIdx.x == 0)
    f.splats.counters->places = counters[1].first_place = first_place + places;
  const uint32_t end = min(places, f.splats.places - min(first_place, f.splats.places));
  const bool all = f.rows.rows == nullptr;
  const uint32_t rows = all ? (end + kRowPlaces - 1) / kRowPlaces : *f.rows.count;
  constexpr uint32_t kWarps = kCullThreads / 32, kRows = kWarps * kCullItems;
  for (uint32_t base = blockIdx.x * kRows; base < rows; base += gridDim.x * kRows) {
    uint32_t places_of[kCullItems], whole[kCullItems], blended[kCullItems], nodes[kCullItems];
    GaussianHull hulls[kCullItems];  // read together: one waits as long as all
#pragma unroll
    for (unsigned k = 0; k < kCullItems; ++k) {
      const uint32_t at = base + k * kWarps + threadIdx.x / 32;
      const uint32_t row = all || at >= rows ? at : __ldg(f.rows.rows + at);
      const uint32_t place = places_of[k] = row * kRowPlaces + lane_in_warp();
      nodes[k] = at < rows && place < end ? node_at(f.draws.list, place) : kNoNode;
    }
#pragma unroll
    for (unsigned k = 0; k < kCullItems; ++k)
      hulls[k] = nodes[k] == kNoNode ? GaussianHull{} : hull_at(f.gaussians, nodes[k]);
#pragma unroll
    for (unsigned k = 0; k < kCullItems; ++k) {
      const uint32_t place = places_of[k];
      float t = 1.0f;
      const DrawItem item = weighed_item<kLod>(f, place, nodes[k], t);
      const bool reaches = project_may_show<kLod, kEyes, kSecond>(f, item, hulls[k]);
      const bool blends = kLod && item.t != 1.0f;
      if (kLod && reaches && f.draws.weights.origin != nullptr) f.draws.weights.weights[place] = t;
      whole[k] = __ballot_sync(kAllLanes, reaches && !blends);
      blended[k] = kLod ? __ballot_sync(kAllLanes, reaches && blends) : 0;
    }
    append_places(whole, &counters->whole, found, first,
                  [&](uint32_t at, unsigned k) { f.splats.candidates[at] = places_of[k]; });
    if (kLod)
      append_places(blended, &counters->blended, found, first, [&](uint32_t at, unsigned k) {
        f.splats.candidates[f.splats.places - 1 - at] = places_of[k];
      });
  }
}

// Of the candidates, in whole warps of either kind; kNoNode for none.
struct Candidates {
  const uint32_t* places;
  uint32_t whole, blended, room;

  __device__ Candidates(const SplatFrame& f, const InstanceCounters& counters)
      : places(f.splats.candidates),
        whole(counters.whole),
        blended(counters.blended),
        room(f.splats.places) {}
  __device__ uint32_t whole_warps() const { return (whole + 31) & ~31u; }
  __device__ uint32_t end() const { return whole_warps() + blended; }
  __device__ uint32_t operator()(uint32_t at) const {
    if (at < whole) return places[at];
    const uint32_t of_blended = at - whole_warps();
    return at >= whole_warps() && of_blended < blended ? places[room - 1 - of_blended] : kNoNode;
  }
};

__device__ SplatRecord record_of(const Splat& s, float log_scale) {
  return {s.x,     s.y, s.conic.p_x, s.conic.q_y, s.conic.skew, s.log_opacity * log_scale,
          s.depth, s.t, s.colour.x,  s.colour.y,  s.colour.z,   s.inverse_k};
}

template <class Sh, bool kLod, int kEyes>
__global__ void __launch_bounds__(kProjectThreads, kEyes == 1 ? 0 : kPairBlocks)
    project_splats(SplatFrame f, bool boxes) {
  if (!has_work(f.splats)) return;
  const DeviceArrays<Sh> arrays{f.gaussians};
  const InstanceCounters& counters = f.splats.counters->instances[f.instance];
  const uint32_t first_place = counters.first_place;
  const Candidates candidates(f, counters);
  uint32_t visible = 0;
  unsigned long long boxed = 0;
  const uint32_t first = blockIdx.x * kProjectThreads + threadIdx.x / 32 * 32;
  __shared__ WarpExtents extents[kProjectThreads / 32];
  // Whole warps together: they share the strips of their splats.
  for (uint32_t base = first; base < candidates.end(); base += gridDim.x * kProjectThreads) {
    const uint32_t place = candidates(base + lane_in_warp());
    TileExtent extent[kEyes] = {};
    float depth[kEyes] = {};
    uint32_t rank = 0;  // among the places of all instances
    if (place != kNoNode) {
      const DrawItem item = item_at<kLod>(f.gaussians, f.draws.list, place);
      rank = first_place + (f.draws.ids == nullptr ? place : __ldg(f.draws.ids + place));
      DrawnGaussian drawn;
      // A rank beyond the room is skipped. Its place was counted, so the next frame has the room.
      if (rank < f.splats.places && read_gaussian(f.params[0], arrays, item, drawn)) {
#pragma unroll
        for (int eye = 0; eye < kEyes; ++eye) {
          Splat splat;
          const ProjectParams& params = f.params[eye];
          if (!project(params, arrays, item, drawn, splat)) continue;
          const SplatRecord record = record_of(splat, params.log_scale);
          f.splats.records[slot_of(f.splats, rank, eye)] = record;
          extent[eye] = tile_extent(support_of(record, params.log_scale, params.log_threshold),
                                    f.splats.frame.grids[eye]);
          depth[eye] = splat.depth;
          ++visible;
          boxed += extent[eye].boxed();
        }
      }
    }
#pragma unroll
    for (int eye = 0; eye < kEyes; ++eye)
      write_strips<kEyes>(extents[threadIdx.x / 32], extent[eye], f.splats, eye, depth[eye],
                          slot_of(f.splats, rank, eye), boxes);
  }
  visible = __reduce_add_sync(kAllLanes, visible);
  boxed = warp_sum(boxed);
  if (lane_in_warp() != 0 || visible == 0) return;
  atomicAdd(&f.splats.counters->splats, visible);
  atomicAdd(&f.splats.counters->pairs_boxed, boxed);
}

template <class Sh, bool kLod, int kEyes>
void launch(const SplatFrame& f, bool boxes) {
  constexpr auto kernel = project_splats<Sh, kLod, kEyes>;
  const unsigned resident = resident_blocks<kernel, kProjectThreads>();
  launch_kernel("project_splats", kernel, {f.multiprocessors * resident, kProjectThreads, f.stream},
                f, boxes);
}

template <bool kLod, int kEyes, bool kSecond>
void launch_cull(const SplatFrame& f) {
  constexpr auto cull = project_cull<kLod, kEyes, kSecond>;
  const unsigned resident = resident_blocks<cull, kCullThreads>();
  launch_kernel("project_cull", cull, {f.multiprocessors * resident, kCullThreads, f.stream}, f);
}

template <bool kLod, int kEyes>
void launch_for(const SplatFrame& f, bool boxes) {
  if (f.splats.open_parts == nullptr)
    launch_cull<kLod, kEyes, false>(f);
  else
    launch_cull<kLod, kEyes, true>(f);
  with_sh(f.gaussians, [&]<class Sh>() { launch<Sh, kLod, kEyes>(f, boxes); });
}

template <int kEyes>
void launch_for(const SplatFrame& f, bool boxes) {
  if (f.draws.list.weights != nullptr) return launch_for<true, kEyes>(f, boxes);
  launch_for<false, kEyes>(f, boxes);
}

}  // namespace

bool launch_project(const SplatFrame& frame, bool alpha_filter) {
  if (frame.draws.list.room == 0) return false;
  static_assert(kMaxEyes == 2);
  if (frame.splats.frame.eyes == 1)
    launch_for<1>(frame, !alpha_filter);
  else
    launch_for<2>(frame, !alpha_filter);
  return true;
}

}  // namespace voyager::cuda
