// Gives an instance's candidates their slots, in the order of their ranks, by adding up how many
// candidates each row has.
#include <algorithm>
#include <cub/block/block_reduce.cuh>
#include <cub/block/block_scan.cuh>

#include "cuda/device/grid.h"
#include "cuda/device/launch.cuh"
#include "cuda/splat/occlusion.cuh"
#include "cuda/splat/project_slots.h"

namespace voyager::cuda {
namespace {

constexpr unsigned kThreads = 512, kItems = kSumRows / kThreads;
using SlotScan = cub::BlockScan<uint32_t, kThreads, cub::BLOCK_SCAN_WARP_SCANS>;
using SlotSum = cub::BlockReduce<uint32_t, kThreads>;

// A block's sum with the tag of its launch, so that sums of earlier launches need not be cleared.
__device__ unsigned long long tagged(uint32_t tag, uint32_t sum) {
  return static_cast<unsigned long long>(tag) << 32 | sum;
}

__device__ uint32_t wait_for_sum(const unsigned long long* from, uint32_t tag) {
  for (;;) {
    const unsigned long long value = *static_cast<const volatile unsigned long long*>(from);
    if (value >> 32 == tag) return static_cast<uint32_t>(value);
  }
}

// Each block waits for those before it alone. That blocks begin in their order is taken for
// granted, as CUB's scans do.
__global__ void __launch_bounds__(kThreads) project_slots(SplatFrame f) {
  if (!has_work(f.splats)) return;
  __shared__ union {
    SlotScan::TempStorage scan;
    SlotSum::TempStorage sum;
  } storage;
  __shared__ uint32_t before;
  InstanceCounters* const counters = f.splats.counters->instances + f.instance;
  const uint32_t room = f.splats.places / kRowPlaces;
  const uint32_t begin = min(counters[0].first_rank / kRowPlaces, room);
  const uint32_t end = min(counters[1].first_rank / kRowPlaces, room);
  const uint32_t blocks = max((end - begin + kSumRows - 1) / kSumRows, 1u);
  if (blockIdx.x >= blocks) return;
  const uint32_t first = begin + blockIdx.x * kSumRows + threadIdx.x * kItems;
  uint32_t slots[kItems], sum;
#pragma unroll
  for (unsigned k = 0; k < kItems; ++k)
    slots[k] = first + k < end ? __popc(f.splats.ranks[first + k].candidates) : 0;
  SlotScan(storage.scan).ExclusiveSum(slots, slots, sum);
  const uint32_t tag = f.splats.rank_tag + f.instance;
  if (threadIdx.x == 0)
    *static_cast<volatile unsigned long long*>(f.splats.rank_sums + blockIdx.x) = tagged(tag, sum);
  uint32_t earlier = threadIdx.x == 0 ? counters->first_slot : 0;
  for (uint32_t i = threadIdx.x; i < blockIdx.x; i += kThreads)
    earlier += wait_for_sum(f.splats.rank_sums + i, tag);
  __syncthreads();
  earlier = SlotSum(storage.sum).Sum(earlier);
  if (threadIdx.x == 0) before = earlier;
  __syncthreads();
#pragma unroll
  for (unsigned k = 0; k < kItems; ++k)
    if (first + k < end) f.splats.ranks[first + k].first_slot = before + slots[k];
  if (threadIdx.x == 0 && blockIdx.x + 1 == blocks)
    f.splats.counters->slots = counters[1].first_slot = before + sum;
}

// For lists whose ranks are not their places: project_cull then sets bits one by one.
__global__ void __launch_bounds__(kThreads) project_clear(SplatFrame f) {
  if (!has_work(f.splats)) return;
  const uint32_t room = f.splats.places / kRowPlaces;
  const uint32_t begin = f.splats.counters->instances[f.instance].first_rank / kRowPlaces;
  const uint32_t end = min(begin + (*f.draws.list.size + kRowPlaces - 1) / kRowPlaces, room);
  for (uint32_t row = begin + blockIdx.x * kThreads + threadIdx.x; row < end;
       row += gridDim.x * kThreads)
    f.splats.ranks[row].candidates = 0;
}

}  // namespace

void launch_clear_ranks(const SplatFrame& f) {
  const unsigned resident = resident_blocks<project_clear, kThreads>();
  launch_kernel("project_clear", project_clear, {f.multiprocessors * resident, kThreads, f.stream},
                f);
}

void launch_slots(const SplatFrame& f) {
  if (f.splats.places == 0) return;  // memory ran out
  const uint32_t rows = std::min(f.draws.list.room, f.splats.places) / kRowPlaces + 1;
  launch_kernel("project_slots", project_slots,
                {(rows + kSumRows - 1) / kSumRows, kThreads, f.stream}, f);
}

}  // namespace voyager::cuda
