#pragma once
// How a tree is built: what is put together, and what stands in for it (docs/lod-tree.md).
#include <cstdint>

namespace voyager {

enum class TreeKind : uint32_t {
  // HierarchicalGS's: two children by the median of the means, moments matched, extent the longest
  // side of the box.
  hierarchicalgs,
  // Up to four children that look alike, extent by the error of standing in; merged Gaussians have
  // doubles, which blend late (docs/lod-tree.md).
  clustered,
};

// Fields beside `kind` are of clustered trees.
struct TreeRule {
  TreeKind kind = TreeKind::clustered;
  // Gaussians that are clustered among themselves; above, a kd tree. Less finds fewer that look
  // alike, more takes time: it grows as their square.
  uint32_t block = 1024;
  // Gaussians that are looked at together to find out which are hidden by others. A multiple of
  // block, at most 65,536.
  uint32_t exposure_block = 32768;
};

}  // namespace voyager
