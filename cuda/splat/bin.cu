// METHOD §7b: the (tile, splat) pairs, tile by tile. bin_count counts the pairs of each block's
// strips in shared memory and adds them up over the blocks; bin_scatter puts each block's pairs
// where its share of a list begins. Some more of its blocks tell where the lists lie, for those who
// sort and draw them (bin_place.cuh). sort.cu orders each list.
#include <algorithm>

#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/splat/bin_bands.h"
#include "cuda/splat/bin_few.cuh"
#include "cuda/splat/splat_launch.h"

namespace voyager::cuda {
namespace {

// Tiles of a strip that a lane places by itself: few strips are wider, and they would hold up the
// warp.
constexpr uint32_t kNarrow = 4;
constexpr uint32_t kWideLanes = 8, kWideGroups = 32 / kWideLanes;  // that place the others

// The strips of a block, and the tiles that it sees to: a band of those of its region's eye.
struct Share {
  const TileStrip* strips;
  uint32_t count;
  uint32_t first_tile, tiles;

  // Asked for before it is wanted.
  __device__ TileStrip strip(uint32_t i) const { return i < count ? strips[i] : TileStrip{}; }
};

// blocks: of the grid, that have strips.
__device__ Share bin_share(const SplatView& splats, uint32_t band, uint32_t blocks) {
  const uint32_t region = blockIdx.x % kStripRegions, room = splats.strip_room / kStripRegions;
  const uint32_t part = blockIdx.x / kStripRegions, parts = blocks / kStripRegions;
  const uint32_t count = min(*strip_count(splats, region), room);
  const uint32_t each = (count + parts - 1) / parts, first = min(part * each, count);
  const FrameTiles& frame = splats.frame;
  const uint32_t eye = region / (kStripRegions / frame.eyes);
  const uint32_t tile = min(frame.first[eye] + blockIdx.y * band, frame.first[eye + 1]);
  return {splats.strips + region * room + first, min(each, count - first), tile,
          min(band, frame.first[eye + 1] - tile)};
}

// The part of a strip that lies in the band, from the band's first tile on.
__device__ TileRange bin_band(const TileStrip& strip, const Share& share) {
  const uint32_t begin = max(strip.first_tile, share.first_tile);
  const uint32_t end = min(strip.first_tile + strip.tiles, share.first_tile + share.tiles);
  if (begin >= end) return {0, 0};
  return {static_cast<int32_t>(begin - share.first_tile),
          static_cast<int32_t>(end - share.first_tile)};
}

// Where this block's pairs of a tile begin in its list, from the list's first.
__device__ uint32_t* bin_offsets(const SplatView& splats, const Share& share) {
  return splats.tile_offsets + size_t{blockIdx.x} * splats.frame.count() + share.first_tile;
}

// Whether a pair is in its tile's list. depth: of its key.
template <bool kLimited>
__device__ bool bin_takes(const SplatView& splats, uint32_t tile, uint32_t depth) {
  return !kLimited || depth <= __ldg(splats.limits.bits + tile);
}

// band: tiles of an eye that a block counts in shared memory at a time.
template <bool kLimited>
__global__ void __launch_bounds__(kBinThreads, kBinBlocks)
    bin_count(SplatView splats, uint32_t band) {
  if (!has_work(splats)) return;
  extern __shared__ uint32_t counts[];
  const Share share = bin_share(splats, band, gridDim.x);
  if (kLimited && draws_few(splats)) {
    if (blockIdx.y == 0) count_few(splats, {share.strips, share.count});
    return;
  }
  TileStrip next = share.strip(threadIdx.x);
  for (uint32_t i = threadIdx.x; i < share.tiles; i += kBinThreads) counts[i] = 0;
  __syncthreads();
  for (uint32_t i = threadIdx.x; i < share.count; i += kBinThreads) {
    const TileStrip strip = next;
    next = share.strip(i + kBinThreads);
    const TileRange range = bin_band(strip, share);
    for (int32_t tile = range.begin; tile < range.end; ++tile)
      if (bin_takes<kLimited>(splats, share.first_tile + tile, strip.depth))
        atomicAdd(counts + tile, 1u);
  }
  __syncthreads();
  uint32_t* offsets = bin_offsets(splats, share);
  constexpr uint32_t kAtOnce = 4;  // so that their waits overlap
  for (uint32_t base = threadIdx.x; base < share.tiles; base += kAtOnce * kBinThreads) {
    uint32_t before[kAtOnce];
#pragma unroll
    for (uint32_t k = 0; k < kAtOnce; ++k) {
      const uint32_t i = base + k * kBinThreads, count = i < share.tiles ? counts[i] : 0;
      before[k] = count == 0 ? 0 : atomicAdd(splats.tile_counts + share.first_tile + i, count);
    }
#pragma unroll
    for (uint32_t k = 0; k < kAtOnce; ++k) {
      const uint32_t i = base + k * kBinThreads;
      if (i < share.tiles) offsets[i] = before[k];
    }
  }
}

__device__ void bin_pair(const SplatView& splats, uint32_t place, DepthKey key) {
  if (place < splats.pairs) splats.keys[place] = key;
}

// A strip a lane; the rest of a wide one is for a quarter of the warp.
template <bool kLimited>
__device__ void bin_strip(const SplatView& splats, const Share& share, uint32_t* cursors,
                          const TileRange& range, DepthKey key) {
  const auto begin = static_cast<uint32_t>(range.begin), lane = lane_in_warp();
  const auto tiles = static_cast<uint32_t>(range.end - range.begin);
  const auto take = [&](uint32_t tile, DepthKey of) {
    return bin_takes<kLimited>(splats, share.first_tile + tile, static_cast<uint32_t>(of >> 32))
               ? atomicAdd(cursors + tile, 1u)
               : splats.pairs;
  };
  uint32_t place[kNarrow];
#pragma unroll
  for (uint32_t k = 0; k < kNarrow; ++k) place[k] = k < tiles ? take(begin + k, key) : splats.pairs;
#pragma unroll
  for (uint32_t k = 0; k < kNarrow; ++k) bin_pair(splats, place[k], key);
  unsigned wide = __ballot_sync(kAllLanes, tiles > kNarrow);
  while (wide != 0) {
    unsigned own = wide;
#pragma unroll
    for (uint32_t group = 0; group < kWideGroups; ++group) {
      if (group < lane / kWideLanes) own &= own - 1;
      wide &= wide - 1;
    }
    const int owner = own == 0 ? 0 : __ffs(own) - 1;
    const DepthKey shared_key = __shfl_sync(kAllLanes, key, owner);
    const uint32_t first = __shfl_sync(kAllLanes, begin, owner);
    const uint32_t count = __shfl_sync(kAllLanes, tiles, owner);
    for (uint32_t k = kNarrow + lane % kWideLanes; own != 0 && k < count; k += kWideLanes)
      bin_pair(splats, take(first + k, shared_key), shared_key);
  }
}

// What a block of bin_scatter needs beside its cursors.
union BinScratch {
  BinScan::TempStorage scan;
  BinPlaces places;
};

// The pairs of all tiles before the band's, which are another eye's or another band's.
__device__ unsigned long long bin_before(const SplatView& splats, const Share& share,
                                         BinScratch& scratch) {
  if (share.first_tile == 0) return 0;
  unsigned long long own = 0, all;
  for (uint32_t i = threadIdx.x; i < share.first_tile; i += kBinThreads)
    own += splats.tile_counts[i];
  BinScan(scratch.scan).ExclusiveSum(own, own, all);
  __syncthreads();
  return all;
}

// Where the block's pairs of each tile go. The lists lie one behind the other; what is beyond the
// room is cut off.
__device__ void bin_cursors(const SplatView& splats, const Share& share, BinScratch& scratch,
                            uint32_t* cursors) {
  for (uint32_t i = threadIdx.x; i < share.tiles; i += kBinThreads)
    cursors[i] = splats.tile_counts[share.first_tile + i];
  const unsigned long long first = bin_before(splats, share, scratch);
  __syncthreads();
  // Each thread adds up tiles that lie together. Odd numbers of them: their banks differ.
  const uint32_t each = (share.tiles + kBinThreads - 1) / kBinThreads | 1;
  const uint32_t begin = min(threadIdx.x * each, share.tiles), end = min(begin + each, share.tiles);
  unsigned long long own = 0, before;
  for (uint32_t i = begin; i < end; ++i) own += cursors[i];
  BinScan(scratch.scan).ExclusiveSum(own, before);
  before += first;
  for (uint32_t i = begin; i < end; ++i) {
    const uint32_t count = cursors[i];
    cursors[i] = static_cast<uint32_t>(min(before, 0ull + splats.pairs));
    before += count;
  }
  __syncthreads();
  const uint32_t* offsets = bin_offsets(splats, share);
  for (uint32_t i = threadIdx.x; i < share.tiles; i += kBinThreads) cursors[i] += offsets[i];
  __syncthreads();
}

// blocks: that scatter. at_once: tiles that are rasterized at a time.
template <bool kLimited>
__global__ void __launch_bounds__(kBinThreads, kBinBlocks)
    bin_scatter(SplatView splats, uint32_t band, uint32_t blocks, uint32_t at_once) {
  if (!has_work(splats)) return;
  extern __shared__ __align__(16) unsigned char memory[];
  BinScratch& scratch = *reinterpret_cast<BinScratch*>(memory);
  const bool few = kLimited && draws_few(splats);
  if (few && blockIdx.y != 0) return;
  if (blockIdx.x >= blocks) {
    if (few && blockIdx.x == blocks && threadIdx.x < 32) place_few(splats);
    if (!few && blockIdx.y == 0) bin_place(splats, at_once, blockIdx.x - blocks, scratch.places);
    return;
  }
  auto* const cursors = reinterpret_cast<uint32_t*>(memory + sizeof scratch);
  const Share share = bin_share(splats, band, blocks);
  if (few) return scatter_few(splats, {share.strips, share.count});
  TileStrip next = share.strip(threadIdx.x);
  bin_cursors(splats, share, scratch, cursors);
  for (uint32_t base = threadIdx.x / 32 * 32; base < share.count; base += kBinThreads) {
    const TileStrip strip = next;
    next = share.strip(base + kBinThreads + lane_in_warp());
    const DepthKey key = static_cast<DepthKey>(strip.depth) << 32 | strip.slot;
    bin_strip<kLimited>(splats, share, cursors, bin_band(strip, share), key);
  }
}

// most: shared memory that a block may have.
template <bool kLimited>
void launch(const SplatFrame& f, const BinBands& bands, size_t most) {
  const unsigned scattering = bin_blocks(f.multiprocessors);
  const unsigned placing = (f.splats.frame.count() + kPlacedTiles - 1) / kPlacedTiles;
  const size_t bytes = bands.tiles * sizeof(uint32_t);
  allow_shared_bytes(bin_count<kLimited>, most, "bin_count");
  launch_kernel("bin_count", bin_count<kLimited>,
                {dim3(scattering, bands.bands), kBinThreads, f.stream, bytes}, f.splats,
                bands.tiles);
  allow_shared_bytes(bin_scatter<kLimited>, most, "bin_scatter");
  launch_kernel(
      "bin_scatter", bin_scatter<kLimited>,
      {dim3(scattering + placing, bands.bands), kBinThreads, f.stream, sizeof(BinScratch) + bytes},
      f.splats, bands.tiles, scattering, kRasterBlocks * f.multiprocessors);
}

}  // namespace

// How many blocks have strips: as many as are resident, since one more would run alone at the end.
unsigned bin_blocks(unsigned multiprocessors) {
  return std::max(kBinBlocks * multiprocessors / kStripRegions, 1u) * kStripRegions;
}

void launch_bin(const SplatFrame& f) {
  uint32_t most = 0;  // tiles of an eye
  for (uint32_t eye = 0; eye < f.splats.frame.eyes; ++eye)
    most = std::max(most, f.splats.frame.first[eye + 1] - f.splats.frame.first[eye]);
  const size_t bytes = shared_bytes_of_block(kBinBlocks);
  static_assert(sizeof(BinScratch) <= kBinScratchBytes);
  const BinBands bands = bin_bands(most, bytes);
  if (f.splats.limits.bits == nullptr)
    launch<false>(f, bands, bytes);
  else
    launch<true>(f, bands, bytes);
}

}  // namespace voyager::cuda
