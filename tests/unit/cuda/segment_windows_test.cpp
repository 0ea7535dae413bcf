// Windows of neighbouring segments: each level divides all segments, down to a bounded number.
#include "cuda/search/segment_windows.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace voyager::cuda {
namespace {

constexpr uint32_t kCounts[] = {0, 1, 15, 16, 17, 48, 4097, 1u << 20, (1u << 20) + 1, 25'165'824};

TEST(SegmentWindows, EachLevelDividesAllSegments) {
  for (const uint32_t count : kCounts) {
    const SegmentWindows windows(count);
    EXPECT_EQ(windows.end(), 2u << windows.depth);
    EXPECT_LE(windows.depth, SegmentWindows::kMostDepth);
    EXPECT_GE(windows.shift, SegmentWindows::kLeastShift);
    for (uint32_t level = 0; level <= windows.depth; ++level) {
      uint32_t end = 0;
      for (uint32_t window = 1u << level; window < 2u << level; ++window) {
        const auto [first, last] = windows.segments_of(window, level);
        if (last <= first) continue;
        EXPECT_EQ(first, end) << count << " segments, level " << level;
        end = last;
      }
      EXPECT_EQ(end, count) << "level " << level;
      for (uint32_t window = 1u << level; level < windows.depth && window < 2u << level; ++window) {
        const auto [first, last] = windows.segments_of(window, level);
        EXPECT_EQ(windows.segments_of(2 * window, level + 1).first, first);
        if (last > first) {
          EXPECT_EQ(std::max(windows.segments_of(2 * window, level + 1).last,
                             windows.segments_of(2 * window + 1, level + 1).last),
                    last);
        }
      }
    }
    EXPECT_EQ(windows.segments_of(1, 0).last, count);
  }
}

TEST(SegmentWindows, ASegmentIsInTheWindowAroundItAndInThoseThatHoldThat) {
  for (const uint32_t count : kCounts) {
    const SegmentWindows windows(count);
    for (const uint32_t segment : {0u, count / 3, count - std::min(count, 1u)}) {
      if (segment >= count) continue;
      uint32_t window = windows.around(segment);
      for (uint32_t level = windows.depth;; --level, window /= 2) {
        const auto [first, last] = windows.segments_of(window, level);
        EXPECT_LE(first, segment);
        EXPECT_GT(last, segment) << count << " segments, level " << level;
        if (level == 0) break;
      }
      EXPECT_EQ(window, 1u);
    }
  }
}

TEST(SegmentWindows, EachLevelHasItsOwnWords) {
  for (uint32_t level = 0; level <= SegmentWindows::kMostDepth; ++level) {
    const uint32_t words =
        SegmentWindows::first_word(level + 1) - SegmentWindows::first_word(level);
    EXPECT_GE(32 * words, 1u << level);
    EXPECT_LE(words, (1u << level) / 32 + 1);
  }
  EXPECT_EQ(SegmentWindows::first_word(SegmentWindows::kMostDepth + 1), SegmentWindows::kMostWords);
}

}  // namespace
}  // namespace voyager::cuda
