#include <gtest/gtest.h>

#include <vector>

#include "runtime/stream/slot_ids.h"

namespace voyager::slot_ids_test {
namespace {

// Runs of these lengths, with gaps between them.
std::vector<uint32_t> ids_of(const std::vector<uint32_t>& lengths) {
  std::vector<uint32_t> ids;
  uint32_t next = 7;
  for (const uint32_t length : lengths) {
    for (uint32_t i = 0; i < length; ++i) ids.push_back(next++);
    next += 3;
  }
  return ids;
}

TEST(SlotIds, NameEveryNode) {
  for (const std::vector<uint32_t>& lengths :
       std::vector<std::vector<uint32_t>>{{1}, {107}, {1, 1, 1}, {30, 50, 27}, {1, 2, 3, 4, 5}}) {
    const std::vector<uint32_t> ids = ids_of(lengths);
    SlotIds slot{};
    ASSERT_TRUE(make_slot_ids(ids, slot));
    for (uint32_t place = 0; place < ids.size(); ++place) EXPECT_EQ(slot.id(place), ids[place]);
  }
}

TEST(SlotIds, AreNoneOfMoreRuns) {
  SlotIds slot{};
  EXPECT_FALSE(make_slot_ids(ids_of({1, 1, 1, 1, 1, 1}), slot));
}

}  // namespace
}  // namespace voyager::slot_ids_test
