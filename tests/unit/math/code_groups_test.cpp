#include "runtime/math/code_groups.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace voyager::code_groups_test {
namespace {

TEST(CodeGroups, BeginWhereTheirBitsAre) {
  std::mt19937 random(7);
  std::vector<RunBlock> blocks(40);
  std::vector<uint32_t> expected;
  uint32_t group = 0;
  for (size_t b = 0; b < blocks.size(); ++b)
    for (uint32_t i = 0; i < 32; ++i) {
      const bool starts = b + i != 0 && random() % (b % 3 == 0 ? 2 : 90) == 0;
      group += starts;
      if (i == 0) blocks[b].first = group;
      if (i != 0 && starts) blocks[b].starts |= 1u << i;
      expected.push_back(group);
    }
  const CodeGroups groups{blocks.data(), 0};
  for (uint32_t i = 0; i < expected.size(); ++i) ASSERT_EQ(groups(i), expected[i]) << i;
  const CodeGroups of_slots{nullptr, 107};
  EXPECT_EQ(of_slots(106), 0u);
  EXPECT_EQ(of_slots(107 * 9), 9u);
}

}  // namespace
}  // namespace voyager::code_groups_test
