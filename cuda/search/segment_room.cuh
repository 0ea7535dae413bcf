#pragma once
// Where segments of the list have no room for their nodes, as few of their neighbours as there have
// to be make some: those in the smallest window that has room for all of its segments. Windows are
// aligned, each of a power of two of segments, so two are apart or one holds the other, and what is
// found does not depend on the order in which they are tried. A thread block does it together.
#include "cuda/device/warp.cuh"
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
__device__ inline uint32_t least_room(uint32_t size, SegmentFit fit) {
  if (size == 0 || fit != SegmentFit::roomy) return whole_rows(size);
  return whole_rows(size + size / 16 + kRowPlaces);
}

// Of `rows` that are shared out by need, what those have that need the first `ahead` of `need`
// places.
__device__ inline uint32_t spare_before(uint32_t rows, uint32_t ahead, uint32_t need) {
  return need == 0 ? 0 : static_cast<uint32_t>(uint64_t{rows} * ahead / need) * kRowPlaces;
}

// In shared memory. Window 1 is all segments; the halves of window w are 2w and 2w + 1.
class SegmentWindows {
 public:
  // All threads; a barrier has to follow. None is marked then.
  __device__ void begin(uint32_t segments, SegmentFit fit);
  // The smallest window around a segment that has outgrown its room. Any thread, any number of
  // times.
  __device__ void mark(uint32_t segment) { mark_window((1u << depth_) + (segment >> shift_)); }
  // All threads, after a barrier. Gives the segments around those that are marked new places and
  // adds their blocks to `dirty`; false, and nothing is changed, where all segments together have
  // no room, or so many would have to move that it is quicker to move all.
  __device__ bool make_room(const StateView& state, Dirty& dirty);

 private:
  // A warp looks through so many segments, no more: by then the whole block is faster.
  static constexpr uint32_t kLeastShift = 4, kMostShift = 12;
  static constexpr uint32_t kMostDepth = 16;

  struct Range {
    uint32_t first, last;
  };
  __device__ Range segments_of(uint32_t window) const {
    const uint32_t level = depth_ - (31 - __clz(window)), width = shift_ + level;
    const uint32_t first = (window - (1u << (depth_ - level))) << width;
    return {first, min(first + (1u << width), count_)};
  }
  __device__ void mark_window(uint32_t window) {
    atomicOr(marked_ + window / 32, 1u << (window % 32));
  }
  __device__ bool is_marked(uint32_t window) const {
    return (marked_[window / 32] >> (window % 32) & 1) != 0;
  }
  __device__ bool is_within_marked(uint32_t window) const {
    for (window /= 2; window != 0; window /= 2)
      if (is_marked(window)) return true;
    return false;
  }
  // By warps in turn: each window of [first, last) that is marked.
  template <class Visit>
  __device__ void for_marked(uint32_t first, uint32_t last, const Visit& visit) const {
    const uint32_t end = (last + 31) / 32;
    for (uint32_t word = first / 32 + threadIdx.x / 32; word < end; word += blockDim.x / 32)
      for (uint32_t bits = marked_[word]; bits != 0; bits &= bits - 1) {
        const uint32_t window = 32 * word + __ffs(bits) - 1;
        if (window >= first && window < last) visit(window);
      }
  }
  struct Places {
    uint32_t need, room;
  };
  __device__ Places places_of(const StateView& state, uint32_t window) const;
  __device__ void share_room(const StateView& state, uint32_t window, Dirty& dirty) const;

  SegmentFit fit_;
  uint32_t count_, depth_, shift_;  // segments; of the smallest windows: depth, log2 of their width
  uint32_t marked_[(2u << kMostDepth) / 32];
};

__device__ inline void SegmentWindows::begin(uint32_t segments, SegmentFit fit) {
  uint32_t shift = kLeastShift, depth = 0;
  while ((segments - 1) >> (shift + kMostDepth) != 0) ++shift;
  while ((segments - 1) >> (shift + depth) != 0) ++depth;
  if (threadIdx.x == 0) fit_ = fit, count_ = segments, depth_ = depth, shift_ = shift;
  for (uint32_t word = threadIdx.x; word < ((2u << depth) + 31) / 32; word += blockDim.x)
    marked_[word] = 0;
}

// By a warp, as share_room().
__device__ inline SegmentWindows::Places SegmentWindows::places_of(const StateView& state,
                                                                   uint32_t window) const {
  const Range range = segments_of(window);
  uint32_t need = 0, room = 0;
  for (uint32_t i = range.first + lane_in_warp(); i < range.last; i += 32) {
    need += least_room(state.segments[i].size, fit_);
    room += state.segments[i].room;
  }
  return {__reduce_add_sync(kAllLanes, need), __reduce_add_sync(kAllLanes, room)};
}

// By what each segment needs.
__device__ inline void SegmentWindows::share_room(const StateView& state, uint32_t window,
                                                  Dirty& dirty) const {
  const Range range = segments_of(window);
  const auto [need, room] = places_of(state, window);
  const uint32_t rows = (room - need) / kRowPlaces, begin = state.segments[range.first].first;
  uint32_t before = 0;  // needed by those in front
  for (uint32_t base = range.first; base < range.last; base += 32) {
    const uint32_t i = base + lane_in_warp();
    const uint32_t size = i < range.last ? state.segments[i].size : 0;
    const uint32_t own = least_room(size, fit_);
    const uint32_t behind = before + warp_scan(own), ahead = behind - own;
    __syncwarp();
    if (i < range.last) {
      const uint32_t spare = spare_before(rows, ahead, need);
      state.segments[i].first = begin + ahead + spare;
      state.segments[i].room = own + spare_before(rows, behind, need) - spare;
      if (size != 0) dirty.add(block_of_segment(state, i));
    }
    before = __shfl_sync(kAllLanes, behind, 31);
  }
}

__device__ inline bool SegmentWindows::make_room(const StateView& state, Dirty& dirty) {
  for (uint32_t depth = depth_;; --depth) {
    bool failed = false;
    for_marked(1u << depth, 2u << depth, [&](uint32_t window) {
      const auto [need, room] = places_of(state, window);
      if (need <= room) return;
      failed = true;
      if (lane_in_warp() == 0 && depth != 0) mark_window(window / 2);
    });
    if (__syncthreads_or(failed) == 0) break;
    if (depth == 0 || shift_ + depth_ - depth >= kMostShift) return false;
  }
  for_marked(1, 2u << depth_, [&](uint32_t window) {
    if (!is_within_marked(window)) share_room(state, window, dirty);
  });
  return true;
}

}  // namespace voyager::cuda
