#pragma once
// Compares what learning may change, and what it must not.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <tuple>

#include "runtime/lod/baked_scene.h"

namespace voyager::test {

// Of the host's memory, so that specks(1500, ...) of degree 1 learns in parts.
inline constexpr uint64_t kMemoryOfParts = 690'000;

// And how detail is chosen.
inline bool same_merged(const BakedScene& a, const BakedScene& b) {
  const auto& [x, y] = std::tie(a.merged, b.merged);
  return x.position == y.position && x.log_scale == y.log_scale && x.rotation == y.rotation &&
         x.opacity == y.opacity && x.sh == y.sh && a.node_code == b.node_code &&
         std::equal(a.tree.records.begin(), a.tree.records.end(), b.tree.records.begin(),
                    [](const NodeRecord& r, const NodeRecord& s) { return r.extent == s.extent; });
}

inline void expect_same_leaves(const BakedScene& a, const BakedScene& b) {
  EXPECT_EQ(a.leaves.position, b.leaves.position);
  EXPECT_EQ(a.leaves.log_scale, b.leaves.log_scale);
  EXPECT_EQ(a.leaves.rotation, b.leaves.rotation);
  EXPECT_EQ(a.leaves.opacity, b.leaves.opacity);
  EXPECT_EQ(a.leaves.sh, b.leaves.sh);
}

}  // namespace voyager::test
