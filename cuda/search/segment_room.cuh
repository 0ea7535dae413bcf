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

// In shared memory, of a block of kThreads. Window 1 is all segments; the halves of window w are 2w
// and 2w + 1.
class SegmentWindows {
 public:
  static constexpr unsigned kThreads = 1024;

  // All threads; a barrier has to follow. None is marked then.
  __device__ void begin(const StateView& state, SegmentFit fit);
  // The smallest window around a segment that has outgrown its room. Any thread, any number of
  // times.
  __device__ void mark(uint32_t segment) {
    mark_window((1u << shape_.depth) + (segment >> shape_.shift));
  }
  // All threads, after a barrier. Gives the segments around those that are marked new places and
  // adds their blocks to `dirty`; false, and nothing is changed, where all segments together have
  // no room, or so many would have to move that it is quicker to move all.
  __device__ bool make_room(const StateView& state, Dirty& dirty);

 private:
  // A warp shares out the room of so many segments, no more: by then the whole block is faster.
  static constexpr uint32_t kMostShift = 12;
  static constexpr unsigned kAtOnce = 4;  // loads of a lane

  struct Range {
    uint32_t first, last;
  };
  __device__ Range segments_of(uint32_t window) const {
    const uint32_t level = shape_.depth - (31 - __clz(window)), width = shape_.shift + level;
    const uint32_t first = (window - (1u << (shape_.depth - level))) << width;
    return {first, min(first + (1u << width), segments_)};
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
  // Each window of [first, last) that is marked, by a warp. Neighbours are different warps'.
  template <class Visit>
  __device__ void for_marked(uint32_t first, uint32_t last, const Visit& visit) const {
    const uint32_t end = (last + 31) / 32, bit = threadIdx.x / 32;
    for (uint32_t base = first / 32; base < end; base += 32) {
      const uint32_t word = base + lane_in_warp(), window = 32 * word + bit;
      const bool is_own = word < end && window >= first && window < last && is_marked(window);
      for (uint32_t own = __ballot_sync(kAllLanes, is_own); own != 0; own &= own - 1)
        visit(32 * (base + __ffs(own) - 1) + bit);
    }
  }
  __device__ WindowPlaces places_of(const StateView& state, Range range) const;
  __device__ WindowPlaces places_of(const StateView& state, uint32_t window) const;
  __device__ void share_room(const StateView& state, uint32_t window, Dirty& dirty) const;

  SegmentFit fit_;
  WindowShape shape_;
  uint32_t segments_;
  uint32_t marked_[WindowShape::kMostWindows / 32];
};

__device__ inline void SegmentWindows::begin(const StateView& state, SegmentFit fit) {
  const uint32_t segments = kLevels * state.block_count;
  const WindowShape shape = window_shape(segments);
  if (threadIdx.x == 0) fit_ = fit, shape_ = shape, segments_ = segments;
  for (uint32_t word = threadIdx.x; word < (shape.windows() + 31) / 32; word += kThreads)
    marked_[word] = 0;
}

// By a warp, as all below.
__device__ inline WindowPlaces SegmentWindows::places_of(const StateView& state,
                                                         Range range) const {
  uint32_t need = 0, room = 0;
#pragma unroll kAtOnce
  for (uint32_t i = range.first + lane_in_warp(); i < range.last; i += 32) {
    need += least_room(state.segments[i].size, fit_);
    room += state.segments[i].room;
  }
  return {__reduce_add_sync(kAllLanes, need), __reduce_add_sync(kAllLanes, room)};
}

// What was found of a half is known.
__device__ inline WindowPlaces SegmentWindows::places_of(const StateView& state,
                                                         uint32_t window) const {
  if (window >> shape_.depth != 0) return places_of(state, segments_of(window));
  const auto half = [&](uint32_t of) {
    return is_marked(of) ? state.windows[of] : places_of(state, segments_of(of));
  };
  const WindowPlaces a = half(2 * window), b = half(2 * window + 1);
  return {a.need + b.need, a.room + b.room};
}

// By what each segment needs.
__device__ inline void SegmentWindows::share_room(const StateView& state, uint32_t window,
                                                  Dirty& dirty) const {
  const Range range = segments_of(window);
  const auto [need, room] = state.windows[window];
  const uint32_t rows = (room - need) / kRowPlaces, begin = state.segments[range.first].first;
  uint32_t before = 0;  // needed by those in front
  for (uint32_t base = range.first; base < range.last; base += 32 * kAtOnce) {
    uint32_t sizes[kAtOnce];
    for (unsigned k = 0; k < kAtOnce; ++k) {
      const uint32_t i = base + 32 * k + lane_in_warp();
      sizes[k] = i < range.last ? state.segments[i].size : 0;
    }
    __syncwarp();  // `begin` has been read
    for (unsigned k = 0; k < kAtOnce; ++k) {
      const uint32_t i = base + 32 * k + lane_in_warp(), own = least_room(sizes[k], fit_);
      const uint32_t behind = before + warp_scan(own), ahead = behind - own;
      if (i < range.last) {
        const uint32_t spare = spare_before(rows, ahead, need);
        state.segments[i].first = begin + ahead + spare;
        state.segments[i].room = own + spare_before(rows, behind, need) - spare;
        if (sizes[k] != 0) dirty.add(block_of_segment(state, i));
      }
      before = __shfl_sync(kAllLanes, behind, 31);
    }
  }
}

__device__ inline bool SegmentWindows::make_room(const StateView& state, Dirty& dirty) {
  const uint32_t deepest = shape_.depth;
  for (uint32_t depth = deepest;; --depth) {
    bool failed = false;
    for_marked(1u << depth, 2u << depth, [&](uint32_t window) {
      const WindowPlaces found = places_of(state, window);
      if (lane_in_warp() == 0) state.windows[window] = found;
      if (found.need <= found.room) return;
      failed = true;
      if (lane_in_warp() == 0 && depth != 0) mark_window(window / 2);
    });
    if (__syncthreads_or(failed) == 0) break;
    if (depth == 0 || shape_.shift + deepest - depth >= kMostShift) return false;
  }
  for_marked(1, 2u << deepest, [&](uint32_t window) {
    if (!is_within_marked(window)) share_room(state, window, dirty);
  });
  return true;
}

}  // namespace voyager::cuda
