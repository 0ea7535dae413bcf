// METHOD §6: each tile's list by depth, ties by id. A warp sorts a short list in registers
// and shared memory, a block a longer one; one that does not fit is sorted in parts, which
// the block then merges in global memory.
#include <algorithm>
#include <cub/block/block_exchange.cuh>
#include <cub/block/block_merge_sort.cuh>
#include <cub/warp/warp_exchange.cuh>
#include <cub/warp/warp_merge_sort.cuh>

#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/splat/occlusion.cuh"
#include "cuda/splat/splat_launch.h"

namespace voyager::cuda {
namespace {

// Odd numbers of keys a thread: a thread's keys lie together in shared memory, and those of
// its neighbours then begin in other banks.
constexpr int kItems = 17;
constexpr int kSortThreads = 128, kSortWarps = kSortThreads / 32;  // of sort_tiles
constexpr int kLargeThreads = 512;                                 // of sort_large
constexpr uint32_t kPart = kLargeThreads * kItems;                 // keys that it sorts at once
static_assert(kShortList <= 32 * kItems && kMediumList <= kSortThreads * kItems);
constexpr DepthKey kLast = ~DepthKey{0};

struct Before {
  __device__ bool operator()(DepthKey a, DepthKey b) const { return a < b; }
};

// Who sorts a list together, kEach keys a thread.
template <int kEach>
struct WarpKeys {
  static constexpr int kThreads = 32;
  using Sort = cub::WarpMergeSort<DepthKey, kEach, kThreads>;
  using Exchange = cub::WarpExchange<DepthKey, kEach, kThreads>;
  static __device__ void sync() { __syncwarp(); }
};
template <int kOfBlock, int kEach>
struct BlockKeys {
  static constexpr int kThreads = kOfBlock;
  using Sort = cub::BlockMergeSort<DepthKey, kThreads, kEach>;
  using Exchange = cub::BlockExchange<DepthKey, kThreads, kEach>;
  static __device__ void sync() { __syncthreads(); }
};
template <int kEach>
using MediumKeys = BlockKeys<kSortThreads, kEach>;
template <int kEach>
using LargeKeys = BlockKeys<kLargeThreads, kEach>;

template <class Keys>
union KeysStorage {
  typename Keys::Sort::TempStorage sort;
  typename Keys::Exchange::TempStorage exchange;
};

// count ≤ kEach times the threads, which `thread` numbers.
template <class Keys, int kEach>
__device__ void sort_keys(KeysStorage<Keys>& storage, DepthKey* keys, uint32_t count,
                          uint32_t thread) {
  constexpr int kThreads = Keys::kThreads;
  DepthKey own[kEach];
#pragma unroll
  for (int k = 0; k < kEach; ++k) {
    const uint32_t at = k * kThreads + thread;
    own[k] = at < count ? keys[at] : kLast;
  }
  typename Keys::Sort(storage.sort).Sort(own, Before{});
  Keys::sync();
  typename Keys::Exchange(storage.exchange)
      .BlockedToStriped(own, own);  // neighbours write together
#pragma unroll
  for (int k = 0; k < kEach; ++k) {
    const uint32_t at = k * kThreads + thread;
    if (at < count) keys[at] = own[k];
  }
}

// The least of the odd numbers below that holds the list.
template <template <int> class KeysOf, int kEach, int... kMore>
struct Sizes {
  using Keys = KeysOf<kEach>;
  using Rest = Sizes<KeysOf, kMore...>;
  union Storage {
    KeysStorage<Keys> own;
    typename Rest::Storage rest;
  };
  static __device__ void sort(Storage& storage, DepthKey* keys, uint32_t count, uint32_t thread) {
    if (count <= kEach * Keys::kThreads)
      sort_keys<Keys, kEach>(storage.own, keys, count, thread);
    else
      Rest::sort(storage.rest, keys, count, thread);
  }
};
template <template <int> class KeysOf, int kEach>
struct Sizes<KeysOf, kEach> {
  using Keys = KeysOf<kEach>;
  using Storage = KeysStorage<Keys>;
  static __device__ void sort(Storage& storage, DepthKey* keys, uint32_t count, uint32_t thread) {
    sort_keys<Keys, kEach>(storage, keys, count, thread);
  }
};

using ShortLists = Sizes<WarpKeys, 3, 5, 7, 9, 13, kItems>;
using MediumLists = Sizes<MediumKeys, 5, 9, 13, kItems>;
using LargeLists = Sizes<LargeKeys, 5, 9, kItems>;

// How many of the first `diagonal` keys of the two sorted runs, merged, come from `a`.
__device__ uint32_t merge_path(const DepthKey* a, uint32_t a_count, const DepthKey* b,
                               uint32_t b_count, uint32_t diagonal) {
  uint32_t low = diagonal > b_count ? diagonal - b_count : 0, high = min(diagonal, a_count);
  while (low < high) {
    const uint32_t middle = (low + high) / 2;
    if (b[diagonal - 1 - middle] < a[middle])
      high = middle;
    else
      low = middle + 1;
  }
  return low;
}

constexpr uint32_t kMergeKeys = 17;  // a thread's share at a time; odd, as kItems
static_assert(kPart % kMergeKeys == 0);

// Runs of `width` keys, two by two; width is a multiple of kMergeKeys.
__device__ void merge_runs(const DepthKey* from, DepthKey* into, uint32_t count, uint64_t width) {
  for (uint32_t first = threadIdx.x * kMergeKeys; first < count;
       first += kLargeThreads * kMergeKeys) {
    const auto pair = static_cast<uint32_t>(first / (2 * width) * (2 * width));
    const auto a_count = static_cast<uint32_t>(min(width, uint64_t{count - pair}));
    const auto b_count = static_cast<uint32_t>(min(width, uint64_t{count - pair - a_count}));
    const DepthKey* a = from + pair;
    const DepthKey* b = a + a_count;
    uint32_t i = merge_path(a, a_count, b, b_count, first - pair);
    uint32_t j = first - pair - i;
    const uint32_t last = min(first + kMergeKeys, pair + a_count + b_count);
    for (uint32_t at = first; at < last; ++at) {
      const bool take_b = i == a_count || (j < b_count && b[j] < a[i]);
      into[at] = take_b ? b[j++] : a[i++];
    }
  }
}

__device__ void sort_in_parts(LargeLists::Storage& storage, DepthKey* keys, DepthKey* spare,
                              uint32_t count) {
  for (uint32_t first = 0; first < count; first += kPart) {
    LargeLists::sort(storage, keys + first, min(kPart, count - first), threadIdx.x);
    __syncthreads();
  }
  DepthKey *from = keys, *into = spare;
  for (uint64_t width = kPart; width < count; width *= 2) {
    merge_runs(from, into, count, width);
    DepthKey* const merged = into;
    into = from, from = merged;
    __syncthreads();
  }
  if (from == keys) return;
  for (uint32_t i = threadIdx.x; i < count; i += kLargeThreads) keys[i] = spare[i];
}

__global__ void __launch_bounds__(kLargeThreads) sort_large(SplatView splats) {
  if (!has_work(splats)) return;
  extern __shared__ __align__(16) unsigned char memory[];  // more than a kernel declares itself
  auto& storage = *reinterpret_cast<LargeLists::Storage*>(memory);
  const uint32_t lists = splats.counters->large_lists;
  for (uint32_t i = blockIdx.x; i < lists; i += gridDim.x) {
    const TileList list = splats.tiles[splats.tile_order[i]];
    sort_in_parts(storage, splats.keys + list.first, splats.merge_keys + list.first,
                  list.last - list.first);
    __syncthreads();
  }
}

union Storage {
  ShortLists::Storage warp[kSortWarps];
  MediumLists::Storage block;
};

// Nine blocks: with fewer registers a thread the sorts spill, with more too few run at once.
__global__ void __launch_bounds__(kSortThreads, 9) sort_tiles(SplatView splats) {
  if (!has_work(splats)) return;
  __shared__ Storage storage;
  const uint32_t lists = list_count(splats), long_lists = splats.counters->long_lists;
  for (uint32_t i = splats.counters->large_lists + blockIdx.x; i < long_lists; i += gridDim.x) {
    const TileList list = splats.tiles[splats.tile_order[i]];
    MediumLists::sort(storage.block, splats.keys + list.first, list.last - list.first, threadIdx.x);
    __syncthreads();
  }
  const uint32_t warp = threadIdx.x / 32;
  const uint32_t queue = (blockIdx.x * kSortWarps + warp) % kSortQueues;
  for (;;) {
    uint32_t taken = 0;
    if (lane_in_warp() == 0) taken = atomicAdd(&splats.counters->queues[queue].taken, 1u);
    const uint32_t i = long_lists + __shfl_sync(kAllLanes, taken, 0) * kSortQueues + queue;
    if (i >= lists) return;
    const TileList list = splats.tiles[splats.tile_order[i]];
    if (list.last - list.first > 1)
      ShortLists::sort(storage.warp[warp], splats.keys + list.first, list.last - list.first,
                       lane_in_warp());
    __syncwarp();
  }
}

}  // namespace

void launch_sort(const SplatFrame& f) {
  constexpr size_t kBytes = sizeof(LargeLists::Storage);
  static_assert(kBytes <= kLeastSharedBytes);
  allow_shared_bytes(sort_large, kBytes, "sort_large");
  // Two on a multiprocessor are what the shared memory of an Orin's has room for.
  launch_kernel("sort_large", sort_large, {2 * f.multiprocessors, kLargeThreads, f.stream, kBytes},
                f.splats);
  const unsigned resident = resident_blocks<sort_tiles, kSortThreads>();
  // Each queue has a warp.
  const unsigned blocks = std::max(f.multiprocessors * resident, kSortQueues / kSortWarps);
  launch_kernel("sort_tiles", sort_tiles, {blocks, kSortThreads, f.stream}, f.splats);
}

}  // namespace voyager::cuda
