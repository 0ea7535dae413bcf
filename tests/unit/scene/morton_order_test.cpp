#include "runtime/scene/export/morton_order.h"

#include <gtest/gtest.h>

#include "runtime/math/morton.h"

namespace voyager::morton_order_test {
namespace {

TEST(MortonOrder, BitsOfTheAxesTakeTurns) {
  EXPECT_EQ(morton_code(1, 0, 0), 1u);
  EXPECT_EQ(morton_code(0, 1, 0), 2u);
  EXPECT_EQ(morton_code(0, 0, 1), 4u);
  EXPECT_EQ(morton_code(2, 3, 0), 0b011010u);
  EXPECT_EQ(morton_code(0x1fffff, 0x1fffff, 0x1fffff), (uint64_t{1} << 63) - 1);
}

TEST(MortonOrder, NamesEachPointOnceOctantByOctant) {
  const std::vector<float> points = {9, 9, 9, 0, 0, 0, 9, 0, 0, 1, 1, 1, 0, 9, 0};
  EXPECT_EQ(morton_order(points), (std::vector<uint32_t>{1, 3, 2, 4, 0}));
}

TEST(MortonOrder, EqualPointsKeepTheirOrder) {
  EXPECT_EQ(morton_order(std::vector<float>(9, 5.0f)), (std::vector<uint32_t>{0, 1, 2}));
  EXPECT_TRUE(morton_order({}).empty());
}

}  // namespace
}  // namespace voyager::morton_order_test
