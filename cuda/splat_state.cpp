#include "cuda/splat_state.h"

#include <algorithm>

#include "runtime/base/error.h"

namespace voyager::cuda {
namespace {

constexpr size_t kFirstSlots = size_t{1} << 18;
constexpr size_t kFirstStrips = size_t{1} << 19, kFirstPairs = size_t{1} << 20;
// Indices are 32 bits; one is no index.
constexpr size_t kMostIndices = 0xfffffffe;

size_t with_spare(size_t wanted) {
  return std::min(wanted + wanted / 4, kMostIndices);
}

// False for want of memory.
template <class Work>
bool tries(const Work& work) {
  try {
    work();
    return true;
  } catch (const Error& error) {
    if (error.code() != ErrorCode::over_budget) throw;
    return false;
  }
}

}  // namespace

SplatState::SplatState(unsigned bin_blocks)
    : bin_blocks_(bin_blocks),
      records_(kFirstSlots),
      candidates_(kFirstSlots),
      keys_(kFirstPairs),
      merge_keys_(kFirstPairs),
      strips_(kFirstStrips) {}

void SplatState::fit(const TileGrid& grid) {
  const size_t tiles = static_cast<size_t>(grid.columns) * static_cast<size_t>(grid.rows);
  if (tiles <= tiles_.size()) return;
  counters_ = Buffer<unsigned char>(sizeof(SplatCounters) + tiles * sizeof(uint32_t));
  tile_offsets_ = Buffer<uint32_t>(tiles * bin_blocks_);
  tile_order_ = Buffer<uint32_t>(tiles);
  tiles_ = Buffer<TileList>(tiles);
}

// The old buffers go first: nothing in them outlives a frame.
bool SplatState::grow_slots(size_t wanted) {
  const size_t before = records_.size();
  const auto allocate = [&](size_t slots) {
    records_ = {}, candidates_ = {};
    records_ = Buffer<SplatRecord>(slots);
    candidates_ = Buffer<uint32_t>(slots);
  };
  if (tries([&] { allocate(with_spare(wanted)); })) return true;
  allocate(before);
  return false;
}

bool SplatState::grow_strips(size_t wanted) {
  const size_t before = strips_.size();
  const auto allocate = [&](size_t strips) {
    strips_ = {};
    strips_ = Buffer<TileStrip>(strips);
  };
  if (tries([&] { allocate(with_spare(wanted)); })) return true;
  allocate(before);
  return false;
}

bool SplatState::grow_pairs(size_t wanted) {
  const size_t before = keys_.size();
  const auto allocate = [&](size_t pairs) {
    keys_ = {}, merge_keys_ = {};
    keys_ = Buffer<DepthKey>(pairs);
    merge_keys_ = Buffer<DepthKey>(pairs);
  };
  if (tries([&] { allocate(with_spare(wanted)); })) return true;
  allocate(before);
  return false;
}

bool SplatState::grow(const SplatCounters& counters) {
  bool grown = false;
  if (counters.places > records_.size()) grown |= grow_slots(counters.places);
  if (counters.strips > strips_.size()) grown |= grow_strips(counters.strips);
  if (counters.pairs > keys_.size() && keys_.size() < kMostIndices)
    grown |= grow_pairs(counters.pairs);
  return grown;
}

SplatView SplatState::view(const TileGrid& grid) const {
  return {records_.data(),
          candidates_.data(),
          static_cast<uint32_t>(records_.size()),
          strips_.data(),
          static_cast<uint32_t>(strips_.size()),
          keys_.data(),
          merge_keys_.data(),
          static_cast<uint32_t>(keys_.size()),
          reinterpret_cast<SplatCounters*>(counters_.data()),
          reinterpret_cast<uint32_t*>(counters_.data() + sizeof(SplatCounters)),
          tile_offsets_.data(),
          tiles_.data(),
          tile_order_.data(),
          grid};
}

void SplatState::begin_frame(const TileGrid& grid, cudaStream_t stream) const {
  const size_t tiles = static_cast<size_t>(grid.columns) * static_cast<size_t>(grid.rows);
  check(cudaMemsetAsync(counters_.data(), 0, sizeof(SplatCounters) + tiles * sizeof(uint32_t),
                        stream),
        "a frame's counters");
}

}  // namespace voyager::cuda
