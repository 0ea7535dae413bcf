// METHOD §6–8: each tile's list, front to back. A warp has a part of the tile, a lane two of its
// pixels, or one where the list is long. The warp takes 32 splats of the list at a time, a lane
// each, drops those that miss its part, and blends the others one after the other. Warps wait for
// nobody.
#include <algorithm>
#include <array>

#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/splat/occlusion.cuh"
#include "cuda/splat/raster_lane.cuh"
#include "cuda/splat/raster_output.cuh"
#include "cuda/splat/raster_part.cuh"
#include "cuda/splat/splat_launch.h"

namespace voyager::cuda {
namespace {

constexpr int kWarps = 4;  // a tile's, or those of one of its halves
constexpr unsigned kThreads = 32 * kWarps;

// The splats that a warp blends, in the order of the list.
struct WarpSplats {
  float4 shape[32], middle[32], colour[32];
};

struct RasterParams {
  SplatView splats;
  RasterEye eyes[kMaxEyes];
  const float* lut;
  uint32_t lut_size;
  float log_threshold;  // a splat contributes where log α, in the exponential's base, is no less
};

// A list's splats, 32 at a time, asked for before they are wanted.
struct Reader {
  const SplatRecord* records;
  const DepthKey* keys;
  uint32_t last;
  uint32_t next_slot;
  RasterSplat next{};  // also of lanes beyond the end, which are tested with the others

  __device__ Reader(const SplatView& splats, const TileList& list, uint32_t lane)
      : records(splats.records), keys(splats.keys), last(list.last) {
    next_slot = slot_at(list.first + lane);
    read_next();
    next_slot = slot_at(list.first + 32 + lane);
  }
  __device__ uint32_t slot_at(uint32_t at) const {
    return at < last ? slot_of(__ldg(keys + at)) : kNoNode;
  }
  __device__ void read_next() {
    if (next_slot == kNoNode) return;
    const float4* record = reinterpret_cast<const float4*>(records + next_slot);
    next = {__ldg(record), __ldg(record + 1), __ldg(record + 2)};
  }
  // The splat at `at`, if there is one; then that at + 32 is on its way.
  __device__ RasterSplat take(uint32_t at) {
    const RasterSplat splat = next;
    read_next();
    next_slot = slot_at(at + 64);
    return splat;
  }
};

template <class Lane>
__device__ bool all_ended(const Lane& lane) {
  bool all = true;
#pragma unroll
  for (int row = 0; row < Lane::kRows; ++row) all &= lane.ended(row);
  return __all_sync(kAllLanes, all);
}

// From how far the warp's pixels still take splats; -inf once all have ended.
template <class Lane>
__device__ float farthest_of(const Lane& lane) {
  float z = -kInfinity;
#pragma unroll
  for (int row = 0; row < Lane::kRows; ++row)
    if (!lane.ended(row)) z = fmaxf(z, lane.farthest(row));
#pragma unroll
  for (int other = 16; other > 0; other /= 2) z = fmaxf(z, __shfl_xor_sync(kAllLanes, z, other));
  return z;
}

constexpr int kUnrolled = 4;  // splats that a loop takes at once, so that they overlap

// kMost: of the splats in [first, last).
template <Siblings kMost, class Lane>
__device__ void blend_chosen(const WarpSplats& chosen, int first, int last, const Lut& lut,
                             Lane& lane, Counts& counts) {
#pragma unroll(kMost == Siblings::many ? 1 : kUnrolled)
  for (int i = first; i < last; ++i)
    lane.template blend<kMost>(chosen.shape[i], chosen.middle[i], chosen.colour[i], lut, counts);
}

// siblings: a bit for each splat that is to be corrected. Where few are, only those of their group
// of kUnrolled pay for it.
template <Siblings kMost, class Lane>
__device__ void blend_mixed(const WarpSplats& chosen, int count, unsigned siblings, const Lut& lut,
                            Lane& lane, Counts& counts) {
  if (2 * __popc(siblings) >= count)
    return blend_chosen<kMost>(chosen, 0, count, lut, lane, counts);
  for (int first = 0; first < count;) {
    const unsigned left = siblings >> first;
    // Whole groups up to the next that has one, or that group.
    const int before = left == 0 ? count - first : (__ffs(left) - 1) / kUnrolled * kUnrolled;
    const int last = min(count, first + max(before, kUnrolled));
    if (before != 0)
      blend_chosen<Siblings::none>(chosen, first, last, lut, lane, counts);
    else
      blend_chosen<kMost>(chosen, first, last, lut, lane, counts);
    first = last;
  }
}

// What a warp gathered of 32 places of a list.
struct Gathered {
  int count;
  unsigned siblings;  // a bit for each that is to be corrected
  bool many;          // and some of them for many
};

// Of the splats that the lanes hold, those that may touch the part. Without a branch: the warp
// waits for its other lanes anyhow.
template <class M, class Lane>
__device__ Gathered gather(const RasterSplat& splat, bool within, const Part& part,
                           float log_threshold, WarpSplats& chosen) {
  const uint32_t self = lane_in_warp();
  const bool touches = within & (!M::kFilter | rasterize_touches(splat, part, log_threshold));
  const unsigned lanes = __ballot_sync(kAllLanes, touches);
  __syncwarp();
  const int at = __popc(lanes & ((1u << self) - 1));
  if (touches) {
    chosen.shape[at] = splat.shape;
    chosen.middle[at] = splat.middle;
    chosen.colour[at] = Lane::prepare(splat.colour);
  }
  Gathered gathered{__popc(lanes), 0, false};
  if constexpr (M::kSiblings) {
    const Siblings own =
        touches ? siblings_of<M::kExponential>(splat.middle.w, splat.colour.w) : Siblings::none;
    gathered.siblings = __reduce_or_sync(kAllLanes, own != Siblings::none ? 1u << at : 0);
    gathered.many = __any_sync(kAllLanes, own == Siblings::many);
  }
  return gathered;
}

template <class M, class Lane>
__device__ void blend_gathered(const WarpSplats& chosen, const Gathered& gathered, const Lut& lut,
                               Lane& lane, Counts& counts) {
  if constexpr (!M::kSiblings)
    blend_chosen<Siblings::none>(chosen, 0, gathered.count, lut, lane, counts);
  else if (gathered.many)
    blend_mixed<Siblings::many>(chosen, gathered.count, gathered.siblings, lut, lane, counts);
  else
    blend_mixed<Siblings::few>(chosen, gathered.count, gathered.siblings, lut, lane, counts);
}

// The depth (bits) of the last of the 32 places from first on. From the key: the splat's registers
// are others' by then.
__device__ uint32_t depth_at_end(const SplatView& splats, const TileList& list, uint32_t first) {
  return static_cast<uint32_t>(splats.keys[min(first + 32, list.last) - 1] >> 32);
}

// The depth (bits) behind which the part is full; kDrawAll where the list comes to its end before.
template <class M, class Lane>
__device__ uint32_t rasterize_list(const SplatView& splats, const TileList& list, const Part& part,
                                   float log_threshold, const Lut& lut, WarpSplats& chosen,
                                   Lane& lane, Counts& counts) {
  const uint32_t self = lane_in_warp();
  if (all_ended(lane)) return kDrawNothing;  // none of its pixels is in the image
  Reader reader(splats, list, self);
  float farthest = kInfinity;
  if constexpr (M::kLimits) farthest = farthest_of(lane);
  for (uint32_t first = list.first; first < list.last; first += 32) {
    const RasterSplat splat = reader.take(first + self);
    const bool valid = first + self < list.last;
    bool within = valid;
    if constexpr (M::kLimits) within = valid && splat.middle.z <= farthest;
    const Gathered gathered = gather<M, Lane>(splat, within, part, log_threshold, chosen);
    __syncwarp();
    blend_gathered<M>(chosen, gathered, lut, lane, counts);
    bool ended;
    if constexpr (M::kLimits) {
      // Splats come front to back: behind one that is too far all are.
      farthest = farthest_of(lane);
      ended = __any_sync(kAllLanes, valid && splat.middle.z > farthest);
    } else {
      ended = all_ended(lane);
    }
    if (ended) return depth_at_end(splats, list, first);
  }
  return kDrawAll;
}

// Where one eye has limits and another has none.
__device__ float limit_at(const DepthLimits& limits, uint32_t x, uint32_t y) {
  return limits.values == nullptr ? kInfinity : limits.at(x, y);
}

// What a part of a tile tells of where it ended.
__device__ void note_end(const SplatView& splats, uint32_t tile, uint32_t end) {
  if (lane_in_warp() != 0) return;
  atomicMax(splats.ends + tile, end);
  if (end == kDrawAll && splats.limits.bits != nullptr && splats.limits.bits[tile] != kDrawAll)
    atomicAdd(&splats.counters->open_parts, 1u);
}

// A warp's part of a tile.
struct PartOfTile {
  uint32_t list;
  unsigned column, row;  // of parts of 8x8 pixels
  unsigned below;        // rows from there to its first
};

template <class M, int kRows>
__device__ void rasterize_part(const RasterParams& params, const PartOfTile& of, WarpSplats& chosen,
                               const float* lut_entries) {
  using Lane = typename LaneOf<M, kRows>::Type;
  const uint32_t index = params.splats.frame.eye(of.list);
  const RasterEye& eye = params.eyes[index];
  const uint32_t tile = of.list - params.splats.frame.first[index];
  const auto columns = static_cast<uint32_t>(params.splats.frame.grids[index].columns);
  const unsigned self = lane_in_warp();
  const uint32_t part_x = tile % columns * kTile + of.column * kPartWidth;
  const uint32_t part_y = tile / columns * kTile + of.row * kPartWidth;
  const uint32_t x = part_x + self % kPartWidth, y = part_y + self / kPartWidth;
  const auto row_of = [&](int row) { return y + of.below + row * kLaneRows; };
  const auto inside = [&](int row) {
    return x < eye.target.width && row_of(row) < eye.target.height;
  };
  const auto top = static_cast<float>(part_y + of.below);
  const Part part{static_cast<float>(part_x) + 0.5f, static_cast<float>(part_x + kPartWidth) - 0.5f,
                  top + 0.5f, top + static_cast<float>(Lane::kRows * kLaneRows) - 0.5f};
  Lane lane(static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, static_cast<int>(of.below),
            -params.log_threshold);
#pragma unroll
  for (int row = 0; row < Lane::kRows; ++row)
    if (!inside(row)) lane.end(row);
  if constexpr (M::kLimits)
    for (int row = 0; row < Lane::kRows; ++row)
      lane.set_farthest(row, inside(row) ? limit_at(eye.limits, x, row_of(row)) : -kInfinity);
  Counts counts;
  const Lut lut{lut_entries, static_cast<float>(params.lut_size) / kLutRange};
  const uint32_t end = rasterize_list<M>(params.splats, params.splats.tiles[of.list], part,
                                         params.log_threshold, lut, chosen, lane, counts);
  note_end(params.splats, of.list, end);
#pragma unroll
  for (int row = 0; row < Lane::kRows; ++row)
    if (inside(row)) write_pixel(eye.target, x, row_of(row), lane.pixel(row));
  if constexpr (M::kCount) {
    SplatCounters& sum = *params.splats.counters;
    atomicAdd(&sum.evaluated, static_cast<unsigned long long>(counts.evaluated));
    atomicAdd(&sum.blended, static_cast<unsigned long long>(counts.blended));
  }
}

// A warp has a quarter of the tile.
template <class M>
__device__ void rasterize_tile(const RasterParams& params, uint32_t list, WarpSplats& chosen,
                               const float* lut_entries) {
  const unsigned warp = threadIdx.x / 32;
  rasterize_part<M, 2>(params, {list, warp % 2, warp / 2, 0}, chosen, lut_entries);
}

// A warp has an eighth of the tile. half: 0 the upper, 1 the lower.
template <class M>
__device__ void rasterize_half(const RasterParams& params, uint32_t list, unsigned half,
                               WarpSplats& chosen, const float* lut_entries) {
  const unsigned warp = threadIdx.x / 32;
  rasterize_part<M, 1>(params, {list, warp % 2, half, warp / 2 * kLaneRows}, chosen, lut_entries);
}

// Their entries, in shared memory, where the mode has a table.
template <class M>
__device__ const float* read_lut(const RasterParams& params) {
  extern __shared__ float lut_entries[];
  if constexpr (M::kExponential == Exponential::lut) {
    for (uint32_t i = threadIdx.x; i <= params.lut_size; i += kThreads)
      lut_entries[i] = params.lut[i];
    __syncthreads();
  }
  return lut_entries;
}

// The first tiles have the longest lists and would end last, so they are drawn in halves. Not in
// binary16, where a lane's two pixels are one number.
template <class M>
constexpr bool kHalves = M::kExponential != Exponential::half2;

// The warp's splats by an address that is kept: the compiler would else find it anew for each use.
__device__ WarpSplats& own_splats(WarpSplats (&of_block)[kWarps]) {
  auto address = static_cast<uint32_t>(__cvta_generic_to_shared(of_block + threadIdx.x / 32));
  asm volatile("" : "+r"(address));
  auto* const own = static_cast<WarpSplats*>(__cvta_shared_to_generic(address));
  __builtin_assume(__isShared(own));
  return *own;
}

// A block a tile, or two.
template <class M>
__global__ void __launch_bounds__(kThreads, kRasterBlocks)
    rasterize_tiles(const __grid_constant__ RasterParams params) {
  __shared__ WarpSplats chosen[kWarps];
  const float* lut_entries = read_lut<M>(params);
  WarpSplats& own = own_splats(chosen);
  const uint32_t halved = kHalves<M> ? params.splats.counters->halved_lists : 0;
  if constexpr (kHalves<M>)
    if (blockIdx.x < 2 * halved)
      return rasterize_half<M>(params, params.splats.tile_order[blockIdx.x / 2], blockIdx.x % 2,
                               own, lut_entries);
  const uint32_t at = blockIdx.x - halved;
  if (at < params.splats.frame.count())
    rasterize_tile<M>(params, params.splats.tile_order[at], own, lut_entries);
}

// Draws a second pass, which usually has few tiles or none. Where many tiles are open, those with a
// list come first in tile_order. An open tile without a list keeps the first pass's picture. It is
// a kernel of its own: a loop over tiles takes registers that the loop over splats needs.
template <class M>
__global__ void __launch_bounds__(kThreads)
    rasterize_open_tiles(const __grid_constant__ RasterParams params) {
  if (!has_work(params.splats)) return;
  __shared__ WarpSplats chosen[kWarps];
  const float* lut_entries = read_lut<M>(params);
  WarpSplats& own = own_splats(chosen);
  for (uint32_t at = blockIdx.x; at < list_count(params.splats); at += gridDim.x) {
    const uint32_t tile = params.splats.tile_order[at];
    if (params.splats.limits.bits[tile] == kDrawNothing) return;
    rasterize_tile<M>(params, tile, own, lut_entries);
    __syncwarp();
  }
}

// Places of a list that some part of its tile came to. They are counted by depth, so that later
// places of the same depth count, too.
__device__ uint32_t places_read(const SplatView& splats, uint32_t tile) {
  const TileList list = splats.tiles[tile];
  const uint32_t end = splats.ends[tile];
  uint32_t first = list.first, last = list.last;  // the first that is deeper is in [first, last]
  while (first < last) {
    const uint32_t middle = first + (last - first) / 2;
    if (static_cast<uint32_t>(splats.keys[middle] >> 32) <= end)
      first = middle + 1;
    else
      last = middle;
  }
  return first - list.first;
}

// Apart from what blends, which has no register to spare.
__global__ void __launch_bounds__(kThreads) rasterize_count_places(SplatView splats) {
  uint32_t read = 0;
  for (uint32_t tile = blockIdx.x * kThreads + threadIdx.x; tile < splats.frame.count();
       tile += gridDim.x * kThreads)
    read += places_read(splats, tile);
  read = __reduce_add_sync(kAllLanes, read);
  if (lane_in_warp() == 0)
    atomicAdd(&splats.counters->places_read, static_cast<unsigned long long>(read));
}

template <class M>
size_t lut_bytes(const RasterParams& params) {
  return M::kExponential == Exponential::lut ? (params.lut_size + 1) * sizeof(float) : 0;
}

template <class M>
void launch(const SplatFrame& f, const RasterParams& params) {
  const uint32_t most = f.splats.frame.count();
  const uint32_t blocks = most + (kHalves<M> ? std::min(most, kMaxHalvedLists) : 0);
  launch_kernel("rasterize_tiles", rasterize_tiles<M>,
                {blocks, kThreads, f.stream, lut_bytes<M>(params)}, params);
}

template <class M>
void launch_open(const SplatFrame& f, const RasterParams& params) {
  const unsigned resident = resident_blocks<rasterize_open_tiles<M>, kThreads>();
  launch_kernel("rasterize_open_tiles", rasterize_open_tiles<M>,
                {f.multiprocessors * resident, kThreads, f.stream, lut_bytes<M>(params)}, params);
}

// What a frame asks of its kernel, beside an exponential and the filter.
enum Needs : size_t {
  kColour,
  kColourDepth,
  kSiblings,
  kSiblingsDepth,
  kLimits,  // those kernels find depth, wanted or not
  kSiblingsLimits,
  kOpenTiles,
  kCounted,
  kNeedsCount
};
using Launch = void(const SplatFrame&, const RasterParams&);
constexpr size_t kExponentials = static_cast<size_t>(Exponential::half2) + 1;
using LaunchTable = std::array<std::array<std::array<Launch*, kNeedsCount>, 2>, kExponentials>;

// By Needs. A kernel may do more than a frame needs: the frame is the same.
template <Exponential E, bool kFilter>
constexpr std::array<Launch*, kNeedsCount> launches() {
  //                      siblings, depth, counts, limits
  return {launch<Mode<E, kFilter, false, false, false, false>>,
          launch<Mode<E, kFilter, false, true, false, false>>,
          launch<Mode<E, kFilter, true, false, false, false>>,
          launch<Mode<E, kFilter, true, true, false, false>>,
          launch<Mode<E, kFilter, false, true, false, true>>,
          launch<Mode<E, kFilter, true, true, false, true>>,
          launch_open<Mode<E, kFilter, true, true, false, true>>,
          launch<Mode<E, kFilter, true, true, true, false>>};
}

template <Exponential E>
constexpr std::array<std::array<Launch*, kNeedsCount>, 2> launches_of() {
  return {launches<E, false>(), launches<E, true>()};
}

// Every kernel of this file that draws: [exponential][filter][needs].
constexpr LaunchTable kLaunches = {launches_of<Exponential::exact>(),
                                   launches_of<Exponential::ex2>(), launches_of<Exponential::lut>(),
                                   launches_of<Exponential::half2>()};

static_assert([] {
  for (const auto& by_filter : kLaunches)
    for (const auto& by_needs : by_filter)
      for (Launch* of : by_needs)
        if (of == nullptr) return false;
  return true;
}());

Needs needs_of(const SplatFrame& f, const RasterChoices& choices, const RasterParams& params) {
  if (choices.count_pixels) return kCounted;
  if (f.splats.open_parts != nullptr) return kOpenTiles;
  bool depth = false, limits = false;
  for (uint32_t eye = 0; eye < f.splats.frame.eyes; ++eye) {
    depth = depth || params.eyes[eye].target.has_depth();
    limits = limits || params.eyes[eye].limits.values != nullptr;
  }
  if (limits) return choices.siblings ? kSiblingsLimits : kLimits;
  if (choices.siblings) return depth ? kSiblingsDepth : kSiblings;
  return depth ? kColourDepth : kColour;
}

}  // namespace

void launch_rasterize(const SplatFrame& f, const RasterChoices& choices, const RasterEye* eyes) {
  const float base = is_base_2(choices.exponential) ? kLog2e : 1.0f;
  RasterParams params{f.splats, {}, choices.lut, choices.lut_size, choices.log_threshold * base};
  std::copy_n(eyes, f.splats.frame.eyes, params.eyes);
  const auto& by_needs =
      kLaunches[static_cast<size_t>(choices.exponential)][choices.alpha_filter ? 1 : 0];
  by_needs[needs_of(f, choices, params)](f, params);
  if (choices.count_pixels)
    launch_kernel("rasterize_count_places", rasterize_count_places,
                  {f.multiprocessors, kThreads, f.stream}, f.splats);
}

}  // namespace voyager::cuda
