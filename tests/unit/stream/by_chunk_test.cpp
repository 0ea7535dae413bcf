#include "runtime/stream/by_chunk.h"

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <random>

namespace voyager::by_chunk_test {
namespace {

TEST(ByChunk, KnowsWhatAMapOfTheSameCallsKnows) {
  std::mt19937 random(1);
  const uint32_t chunks = 50;
  ByChunk<std::unique_ptr<int>> known(chunks);
  std::map<uint32_t, int> expected;
  for (int step = 0; step < 5000; ++step) {
    const uint32_t chunk = random() % chunks;
    if (random() % 2 == 0) {
      known.know(chunk) = std::make_unique<int>(step);
      expected[chunk] = step;
    } else {
      known.forget(chunk);
      expected.erase(chunk);
    }
    const uint32_t asked = random() % chunks;
    const auto at = expected.find(asked);
    ASSERT_EQ(known[asked] != nullptr, at != expected.end());
    if (known[asked] != nullptr) {
      ASSERT_EQ(*known[asked], at->second);
    }
    std::map<uint32_t, int> visited;
    known.each([&](uint32_t of, const std::unique_ptr<int>& value) { visited[of] = *value; });
    ASSERT_EQ(visited, expected);
  }
}

}  // namespace
}  // namespace voyager::by_chunk_test
