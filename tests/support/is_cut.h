#pragma once
#include <gtest/gtest.h>

#include <vector>

#include "runtime/lod/tree.h"

namespace voyager::test {

// Whether every path from the root to a leaf meets the cut once. cut: ascending.
inline testing::AssertionResult is_cut(const LodTree& tree, const std::vector<uint32_t>& cut) {
  std::vector<uint8_t> covered(tree.size());
  size_t next = 0;
  for (uint32_t n = 0; n < tree.size(); ++n) {
    const bool above = n != 0 && covered[tree.parent[n]] != 0;
    const bool in_cut = next < cut.size() && cut[next] == n;
    next += in_cut;
    if (above && in_cut) return testing::AssertionFailure() << "node " << n << " is drawn twice";
    covered[n] = above || in_cut;
    if (tree.is_leaf(n) && covered[n] == 0)
      return testing::AssertionFailure() << "nothing stands for leaf " << n;
  }
  if (next != cut.size()) return testing::AssertionFailure() << "node ids that do not ascend";
  return testing::AssertionSuccess();
}

}  // namespace voyager::test
