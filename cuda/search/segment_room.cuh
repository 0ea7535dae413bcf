#pragma once
// Makes room for segments of the list that have outgrown theirs. Each takes it from the narrowest
// window around it that has enough for all of its segments; only these move. Any two windows are
// disjoint or nested, so the result does not depend on the order of threads.
#include "cuda/device/warp.cuh"
#include "cuda/search/block_scan.cuh"
#include "cuda/search/cut_state.h"

namespace voyager::cuda {

// The blocks to be written, each once.
struct Dirty {
  uint32_t* blocks;
  uint32_t* flags;
  uint32_t count;

  __device__ void add(uint32_t block) {
    if (atomicExch(flags + block, 1u) == 0) blocks[atomicAdd(&count, 1u)] = block;
  }
};

__device__ inline uint32_t block_of_segment(const StateView& state, uint32_t segment) {
  uint32_t tier = 0;
  while (tier + 1 < state.tier_count && segment >= kLevels * state.tiers[tier + 1].first_block)
    ++tier;
  const Tier& own = state.tiers[tier];
  return own.first_block + (segment - kLevels * own.first_block) % own.blocks;
}

// What a segment needs when its neighbours make room: less to spare than a roomy one has.
VOYAGER_HD uint32_t least_room(uint32_t size, SegmentFit fit) {
  if (size == 0 || fit != SegmentFit::roomy) return whole_rows(size);
  return whole_rows(size + size / 16 + kRowPlaces);
}

// Of `rows` that are shared out by need, what those have that need the first `ahead` of `need`
// places.
__device__ inline uint32_t spare_before(uint32_t rows, uint32_t ahead, uint32_t need) {
  return need == 0 ? 0 : static_cast<uint32_t>(uint64_t{rows} * ahead / need) * kRowPlaces;
}

// By one thread block of kScanThreads, in shared memory.
class RoomAmongNeighbours {
 public:
  // All threads; a barrier has to follow.
  __device__ void begin(const StateView& state, SegmentFit fit);
  // A segment that has outgrown its room. Any thread, any number of times.
  __device__ void mark(uint32_t segment) { mark(windows_.around(segment), windows_.depth); }
  // All threads, after a barrier. Gives those that are marked room, with new places for them and
  // for those around them, and adds their blocks to `dirty`. False where all segments together have
  // not enough; they are left as they were.
  __device__ bool make(const StateView& state, BlockScan::TempStorage& storage, Dirty& dirty);

 private:
  // Log2 of the segments of the widest window that one warp handles. The whole block handles wider
  // ones.
  static constexpr uint32_t kShiftOfWarp = 12;
  static constexpr unsigned kAtOnce = 4;  // loads of a lane

  // The widest that are a warp's.
  __device__ uint32_t level_of_warps() const {
    const uint32_t levels = kShiftOfWarp > windows_.shift ? kShiftOfWarp - windows_.shift : 0;
    return windows_.depth > levels ? windows_.depth - levels : 0;
  }
  __device__ void mark(uint32_t window, uint32_t level) {
    const uint32_t i = window - (1u << level);
    atomicOr(marked_ + SegmentWindows::first_word(level) + i / 32, 1u << (i % 32));
  }
  __device__ bool is_marked(uint32_t window, uint32_t level) const {
    const uint32_t i = window - (1u << level);
    return (marked_[SegmentWindows::first_word(level) + i / 32] >> (i % 32) & 1) != 0;
  }
  __device__ bool is_within_marked(uint32_t window, uint32_t level) const {
    while (level != 0)
      if (is_marked(window /= 2, --level)) return true;
    return false;
  }
  // Each window of the level that is marked, or not, by a warp; neighbours by different ones.
  static_assert(kScanThreads == 32 * 32);
  template <class Visit>
  __device__ void for_each(uint32_t level, bool marked, const Visit& visit) const {
    const uint32_t count = 1u << level, bit = threadIdx.x / 32;
    for (uint32_t base = 0; base < count; base += 32 * 32) {
      const uint32_t i = base + 32 * lane_in_warp() + bit;
      const bool own = i < count && is_marked(count + i, level) == marked;
      for (uint32_t lanes = __ballot_sync(kAllLanes, own); lanes != 0; lanes &= lanes - 1)
        visit(count + base + 32 * (__ffs(lanes) - 1) + bit);
    }
  }
  __device__ WindowPlaces count(const StateView& state, uint32_t window, uint32_t level) const;
  __device__ WindowPlaces places_of(const StateView& state, uint32_t window, uint32_t level) const;
  __device__ bool find(const StateView& state);
  __device__ bool find_wide(const StateView& state);

  struct Share;
  __device__ Share share_of(const StateView& state, uint32_t window, uint32_t level) const;
  __device__ void share_by_warp(const StateView& state, uint32_t window, uint32_t level,
                                Dirty& dirty) const;
  __device__ void share_by_block(const StateView& state, uint32_t window, uint32_t level,
                                 BlockScan::TempStorage& storage, Dirty& dirty) const;

  SegmentFit fit_;
  SegmentWindows windows_;
  uint32_t marked_[SegmentWindows::kMostWords];
};

__device__ inline void RoomAmongNeighbours::begin(const StateView& state, SegmentFit fit) {
  const SegmentWindows windows(kLevels * state.block_count);
  if (threadIdx.x == 0) fit_ = fit, windows_ = windows;
  const uint32_t words = SegmentWindows::first_word(windows.depth + 1);
  for (uint32_t word = threadIdx.x; word < words; word += kScanThreads) marked_[word] = 0;
}

// By a warp.
__device__ inline WindowPlaces RoomAmongNeighbours::count(const StateView& state, uint32_t window,
                                                          uint32_t level) const {
  const auto [first, last] = windows_.segments_of(window, level);
  uint32_t need = 0, room = 0;
#pragma unroll kAtOnce
  for (uint32_t i = first + lane_in_warp(); i < last; i += 32) {
    need += least_room(state.segments[i].size, fit_);
    room += state.segments[i].room;
  }
  return {__reduce_add_sync(kAllLanes, need), __reduce_add_sync(kAllLanes, room)};
}

// By a warp. A half that is marked has been counted before.
__device__ inline WindowPlaces RoomAmongNeighbours::places_of(const StateView& state,
                                                              uint32_t window,
                                                              uint32_t level) const {
  if (level == windows_.depth) return count(state, window, level);
  const auto half = [&](uint32_t of) {
    return is_marked(of, level + 1) ? state.windows[of] : count(state, of, level + 1);
  };
  return half(2 * window) + half(2 * window + 1);
}

// Marks the windows around those that are marked and have no room, and so on. False where all
// segments together have none.
__device__ inline bool RoomAmongNeighbours::find(const StateView& state) {
  const uint32_t last = level_of_warps();
  for (uint32_t level = windows_.depth;; --level) {
    bool failed = false;
    for_each(level, true, [&](uint32_t window) {
      const WindowPlaces found = places_of(state, window, level);
      if (lane_in_warp() == 0) state.windows[window] = found;
      if (found.fits()) return;
      failed = true;
      if (lane_in_warp() == 0 && level != 0) mark(window / 2, level - 1);
    });
    if (__syncthreads_or(failed) == 0) return true;
    if (level == last) return level != 0 && find_wide(state);
  }
}

__device__ inline bool RoomAmongNeighbours::find_wide(const StateView& state) {
  uint32_t level = level_of_warps();
  for_each(level, false, [&](uint32_t window) {
    const WindowPlaces found = count(state, window, level);
    if (lane_in_warp() == 0) state.windows[window] = found;
  });
  __syncthreads();
  while (level-- != 0) {
    bool failed = false;
    for (uint32_t window = (1u << level) + threadIdx.x; window < 2u << level;
         window += kScanThreads) {
      const WindowPlaces found = state.windows[2 * window] + state.windows[2 * window + 1];
      state.windows[window] = found;
      if (found.fits() || !is_marked(window, level)) continue;
      failed = true;
      if (level != 0) mark(window / 2, level - 1);
    }
    if (__syncthreads_or(failed) == 0) return true;
  }
  return false;
}

// A window's room, by what each segment needs.
struct RoomAmongNeighbours::Share {
  uint32_t begin, need, rows;  // its first place; what all need; rows beside that

  // own: what segment i needs; ahead: those in front of it.
  __device__ void put(const StateView& state, uint32_t i, uint32_t own, uint32_t ahead,
                      Dirty& dirty) const {
    const uint32_t spare = spare_before(rows, ahead, need);
    state.segments[i].first = begin + ahead + spare;
    state.segments[i].room = own + spare_before(rows, ahead + own, need) - spare;
    if (own != 0) dirty.add(block_of_segment(state, i));
  }
};

__device__ inline RoomAmongNeighbours::Share RoomAmongNeighbours::share_of(const StateView& state,
                                                                           uint32_t window,
                                                                           uint32_t level) const {
  const auto [need, room] = state.windows[window];
  return {state.segments[windows_.segments_of(window, level).first].first, need,
          (room - need) / kRowPlaces};
}

__device__ inline void RoomAmongNeighbours::share_by_warp(const StateView& state, uint32_t window,
                                                          uint32_t level, Dirty& dirty) const {
  const auto [first, last] = windows_.segments_of(window, level);
  const Share share = share_of(state, window, level);
  uint32_t before = 0;
  for (uint32_t base = first; base < last; base += 32 * kAtOnce) {
    uint32_t sizes[kAtOnce];
    for (unsigned k = 0; k < kAtOnce; ++k) {
      const uint32_t i = base + 32 * k + lane_in_warp();
      sizes[k] = i < last ? state.segments[i].size : 0;
    }
    __syncwarp();  // all have read where the window begins
    for (unsigned k = 0; k < kAtOnce; ++k) {
      const uint32_t i = base + 32 * k + lane_in_warp(), own = least_room(sizes[k], fit_);
      const uint32_t behind = before + warp_scan(own);
      if (i < last) share.put(state, i, own, behind - own, dirty);
      before = __shfl_sync(kAllLanes, behind, 31);
    }
  }
}

__device__ inline void RoomAmongNeighbours::share_by_block(const StateView& state, uint32_t window,
                                                           uint32_t level,
                                                           BlockScan::TempStorage& storage,
                                                           Dirty& dirty) const {
  const auto [first, last] = windows_.segments_of(window, level);
  const Share share = share_of(state, window, level);
  __syncthreads();  // all have read where it begins
  scan(
      last - first, storage,
      [&](uint32_t i) { return least_room(state.segments[first + i].size, fit_); },
      [&](uint32_t i, uint32_t own, uint32_t ahead) {
        share.put(state, first + i, own, ahead, dirty);
      });
}

__device__ inline bool RoomAmongNeighbours::make(const StateView& state,
                                                 BlockScan::TempStorage& storage, Dirty& dirty) {
  if (!find(state)) return false;
  const uint32_t widest = level_of_warps();
  for (uint32_t level = widest; level <= windows_.depth; ++level)
    for_each(level, true, [&](uint32_t window) {
      if (!is_within_marked(window, level)) share_by_warp(state, window, level, dirty);
    });
  // Below 2^8 windows for lists of up to a million segments.
  for (uint32_t level = 0; level < widest; ++level)
    for (uint32_t window = 1u << level; window < 2u << level; ++window)
      if (is_marked(window, level) && !is_within_marked(window, level))
        share_by_block(state, window, level, storage, dirty);
  return true;
}

}  // namespace voyager::cuda
