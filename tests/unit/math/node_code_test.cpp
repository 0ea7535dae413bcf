// The byte of a node: an axis code and a footprint level.
#include "runtime/math/node_code.h"

#include <gtest/gtest.h>

#include <cmath>

namespace voyager::node_code_test {
namespace {

TEST(NodeCode, HoldsBothOfItsParts) {
  for (int level = 0; level < kFootprintLevels; ++level)
    for (int axis = 0; axis < kAxisCodes; ++axis) {
      const uint8_t code = node_code(axis, level);
      EXPECT_EQ(axis_code_of(code), axis);
      EXPECT_EQ(footprint_level_of(code), level);
    }
  EXPECT_EQ(node_code(23, 0), 23);  // where a scene has one footprint, an axis code
}

TEST(NodeCode, EachLevelHalvesTheFootprintExactly) {
  for (const float v : {0.1f, 3e-12f, 7.7e11f})
    for (int level = 0; level < kFootprintLevels; ++level)
      EXPECT_EQ(footprint_at(v, level), std::ldexp(v, -level));
}

}  // namespace
}  // namespace voyager::node_code_test
