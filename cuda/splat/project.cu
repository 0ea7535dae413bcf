// METHOD §5–7, §12: the Gaussians of a frame to splats. project_cull reads the hulls of the rows
// that may reach the image, where the search keeps bounds of them, weighs their nodes, and lists
// those that may reach the image; these get slots; project_splats reads the rest of them.
#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/scene/device_arrays.cuh"
#include "cuda/scene/gaussian_hull.cuh"
#include "cuda/search/cut_weight.cuh"
#include "cuda/splat/draw_item.cuh"
#include "cuda/splat/occlusion.cuh"
#include "cuda/splat/project_slots.h"
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

// The weight of the node of a place.
template <bool kLod>
__device__ float weight_at(const SplatFrame& f, uint32_t place, uint32_t node) {
  const WeightSource& from = f.draws.weights;
  if (!kLod || node == kNoNode) return 1.0f;
  return from.weighs() ? weight_of(from, node) : __ldg(f.draws.list.weights + place);
}

// What such a node draws.
template <bool kLod>
__device__ DrawItem weighed_item(const GaussianView& gaussians, uint32_t node, float weight) {
  if (!kLod || node == kNoNode) return {node, kNoNode, 1.0f, 1.0f};
  return item_of(gaussians, node, weight);
}

__device__ uint32_t rank_of(const SplatFrame& f, uint32_t first_rank, uint32_t place) {
  return first_rank + (f.draws.ids == nullptr ? place : __ldg(f.draws.ids + place));
}

// Tells project_slots that a warp's places `lanes`, of a row, may reach the image.
__device__ void mark_row(const SplatFrame& f, uint32_t first_rank, uint32_t place, uint32_t lanes) {
  const uint32_t lane = lane_in_warp();
  if (f.draws.ids == nullptr) {
    if (lane == 0) f.splats.ranks[(first_rank + place) / kRowPlaces].candidates = lanes;
  } else if (lanes >> lane & 1) {
    const uint32_t rank = rank_of(f, first_rank, place);
    if (rank < f.splats.places)
      atomicOr(&f.splats.ranks[rank / kRowPlaces].candidates, 1u << rank % kRowPlaces);
  }
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
  const uint32_t first_rank = counters->first_rank;
  if (blockIdx.x == 0 && threadIdx.x == 0) {
    f.splats.counters->places = first_rank + places;
    counters[1].first_rank = (first_rank + places + kRowPlaces - 1) / kRowPlaces * kRowPlaces;
  }
  const uint32_t end = min(places, f.splats.places - min(first_rank, f.splats.places));
  const bool all = f.rows.rows == nullptr;
  const uint32_t rows = all ? (end + kRowPlaces - 1) / kRowPlaces : *f.rows.count;
  constexpr uint32_t kWarps = kCullThreads / 32, kRows = kWarps * kCullItems;
  for (uint32_t base = blockIdx.x * kRows; base < rows; base += gridDim.x * kRows) {
    uint32_t places_of[kCullItems], whole[kCullItems], blended[kCullItems], nodes[kCullItems];
    float weights[kCullItems];
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
      weights[k] = weight_at<kLod>(f, places_of[k], nodes[k]);
      const DrawItem item = weighed_item<kLod>(f.gaussians, nodes[k], weights[k]);
      const bool reaches = project_may_show<kLod, kEyes, kSecond>(f, item, hulls[k]);
      const bool blends = kLod && item.t != 1.0f;
      whole[k] = __ballot_sync(kAllLanes, reaches && !blends);
      blended[k] = kLod ? __ballot_sync(kAllLanes, reaches && blends) : 0;
      if (base + k * kWarps + threadIdx.x / 32 < rows)
        mark_row(f, first_rank, places_of[k], whole[k] | blended[k]);
    }
    const auto put = [&](Candidate* candidates) {
      return [&, candidates](uint32_t at, unsigned k) {
        if (at < f.splats.slots) candidates[at] = {places_of[k], weights[k]};
      };
    };
    append_places(whole, &counters->whole, found, first, put(f.splats.whole));
    if (kLod) append_places(blended, &counters->blended, found, first, put(f.splats.blended));
  }
}

// Of an instance, in whole warps of either kind; their place is kNoNode for none.
struct Candidates {
  const Candidate *whole_from, *blended_from;
  uint32_t whole, blended;

  __device__ Candidates(const SplatFrame& f, const InstanceCounters& counters)
      : whole_from(f.splats.whole),
        blended_from(f.splats.blended),
        whole(min(counters.whole, f.splats.slots)),
        blended(min(counters.blended, f.splats.slots)) {}
  __device__ uint32_t whole_warps() const { return (whole + 31) & ~31u; }
  __device__ uint32_t end() const { return whole_warps() + blended; }
  __device__ Candidate operator()(uint32_t at) const {
    if (at < whole) return whole_from[at];
    const uint32_t of_blended = at - whole_warps();
    if (at >= whole_warps() && of_blended < blended) return blended_from[of_blended];
    return {kNoNode, 1.0f};
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
  const Candidates candidates(f, counters);
  uint32_t visible = 0;
  unsigned long long boxed = 0;
  const uint32_t first = blockIdx.x * kProjectThreads + threadIdx.x / 32 * 32;
  __shared__ WarpExtents extents[kProjectThreads / 32];
  // Whole warps together: they share the strips of their splats.
  for (uint32_t base = first; base < candidates.end(); base += gridDim.x * kProjectThreads) {
    const auto [place, weight] = candidates(base + lane_in_warp());
    TileExtent extent[kEyes] = {};
    float depth[kEyes] = {};
    uint32_t slot = 0;
    if (place != kNoNode) {
      const DrawItem item = weighed_item<kLod>(f.gaussians, node_at(f.draws.list, place), weight);
      const uint32_t rank = rank_of(f, counters.first_rank, place);
      // What is beyond the room is skipped. It was counted, so the next frame has the room.
      bool has_room = rank < f.splats.places;
      if (has_room) slot = f.splats.ranks[rank / kRowPlaces].slot(rank);
      has_room = has_room && slot < f.splats.slots;
      DrawnGaussian drawn;
      if (has_room && read_gaussian(f.params[0], arrays, item, drawn)) {
#pragma unroll
        for (int eye = 0; eye < kEyes; ++eye) {
          Splat splat;
          const ProjectParams& params = f.params[eye];
          if (!project(params, arrays, item, drawn, splat)) continue;
          const SplatRecord record = record_of(splat, params.log_scale);
          f.splats.records[slot_of(f.splats, slot, eye)] = record;
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
                          slot_of(f.splats, slot, eye), boxes);
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
  if (f.draws.ids != nullptr) launch_clear_ranks(f);
  if (f.splats.open_parts == nullptr)
    launch_cull<kLod, kEyes, false>(f);
  else
    launch_cull<kLod, kEyes, true>(f);
  launch_slots(f);
  with_sh(f.gaussians, [&]<class Sh>() { launch<Sh, kLod, kEyes>(f, boxes); });
}

template <int kEyes>
void launch_for(const SplatFrame& f, bool boxes) {
  if (f.draws.blends()) return launch_for<true, kEyes>(f, boxes);
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
