#pragma once
// Windows of neighbouring segments of a list: a binary tree in an array. Window 1 is all segments,
// 2w and 2w + 1 are the halves of w. Level l has 2^l windows.
#include <cstdint>

#include "runtime/math/host_device.h"

namespace voyager::cuda {

struct SegmentWindows {
  // Of the narrowest ones: at least 16 segments, and at most 65,536 windows.
  static constexpr uint32_t kLeastShift = 4, kMostDepth = 16;
  static constexpr uint32_t kMostWords = 4 + (1u << (kMostDepth - 4));

  uint32_t segments;
  uint32_t shift;  // the narrowest have 2^shift segments
  uint32_t depth;  // and are level `depth`

  SegmentWindows() = default;  // as shared memory has it
  VOYAGER_HD explicit constexpr SegmentWindows(uint32_t count)
      : segments(count), shift(kLeastShift), depth(0) {
    const uint32_t last = count == 0 ? 0 : count - 1;
    while (last >> shift >> kMostDepth != 0) ++shift;
    while (last >> shift >> depth != 0) ++depth;
  }

  // Of an array that is indexed by window.
  VOYAGER_HD constexpr uint32_t end() const { return 2u << depth; }
  // The narrowest with this segment.
  VOYAGER_HD constexpr uint32_t around(uint32_t segment) const {
    return (1u << depth) + (segment >> shift);
  }
  struct Range {
    uint32_t first, last;  // segments; none where last <= first
  };
  VOYAGER_HD constexpr Range segments_of(uint32_t window, uint32_t level) const {
    const uint32_t width = shift + (depth - level);  // its log2
    const uint32_t first = (window - (1u << level)) << width, last = first + (1u << width);
    return {first, last < segments ? last : segments};
  }

  // Of an array of bits by window. No two levels share a word.
  static VOYAGER_HD constexpr uint32_t first_word(uint32_t level) {
    return level < 5 ? level : 4 + (1u << (level - 5));
  }
};

}  // namespace voyager::cuda
