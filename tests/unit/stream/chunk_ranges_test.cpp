#include "runtime/stream/chunk_ranges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace voyager::chunk_ranges_test {
namespace {

// As a file's chunks lead to others: ascending, some to none; now and then far away, or to many.
std::vector<ChunkRange> random_ranges(uint32_t seed, size_t count) {
  std::mt19937 random(seed);
  const auto below = [&](uint32_t end) { return static_cast<uint32_t>(random() % end); };
  std::vector<ChunkRange> ranges;
  uint32_t at = 0;
  while (ranges.size() < count) {
    const uint32_t far = below(30) == 0 ? 65'534 + below(4) : 0, many = below(30) == 0 ? far : 0;
    at += far + below(3);
    if (below(40) == 0) at -= std::min(at, below(10));
    ranges.push_back({at, at + (below(4) == 0 ? 0 : below(5) + many)});
    if (below(50) == 0) ranges.back() = {0, 0};
  }
  return ranges;
}

TEST(ChunkRanges, HasEveryRangeAsItWas) {
  for (uint32_t seed = 0; seed < 200; ++seed)
    for (const size_t count : {0u, 1u, 63u, 64u, 65u, 500u}) {
      const std::vector<ChunkRange> expected = random_ranges(seed, count);
      ChunkRanges ranges;
      for (const ChunkRange& range : expected) ranges.add(range);
      ranges.close();
      ASSERT_EQ(ranges.size(), count);
      for (size_t chunk = 0; chunk < count; ++chunk) {
        const ChunkRange found = ranges[chunk];
        ASSERT_EQ(found.empty(), expected[chunk].empty()) << seed << " " << chunk;
        ASSERT_EQ(ranges.is_empty(chunk), expected[chunk].empty()) << seed << " " << chunk;
        if (found.empty()) continue;
        ASSERT_EQ(found.first, expected[chunk].first) << seed << " " << chunk;
        ASSERT_EQ(found.last, expected[chunk].last) << seed << " " << chunk;
      }
    }
}

}  // namespace
}  // namespace voyager::chunk_ranges_test
