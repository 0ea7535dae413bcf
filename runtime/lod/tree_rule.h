#pragma once
// How a tree is built: what is put together, and what stands in for it (docs/lod-tree.md).
#include <cstdint>

namespace voyager {

enum class TreeKind : uint32_t {
  // HierarchicalGS's: two children by the median of the means, moments matched, extent the longest
  // side of the box.
  hierarchicalgs,
  // Up to four children that look alike, extent by the error of standing in.
  clustered,
};

// Of a tree that is built today, LodTree::blend_share. What an extent by error says holds up to
// where the parent takes over; blending is there so that nothing pops.
inline constexpr float kHalfShare = 0.5f, kLateShare = 0.98f;
constexpr float blend_share(TreeKind kind) {
  return kind == TreeKind::hierarchicalgs ? kHalfShare : kLateShare;
}

// What a file's extents are, from which compact storage takes differences.
enum class ExtentRule : uint32_t {
  longest_side,  // of the node's box; a leaf's 0
  error,         // of standing in; a leaf's 0
  // The same in a tree that blends from half of the parent's size on, as files of version 4 have
  // it: leaves, and doubles (nodes that repeat their only child), have 0.98 of the parent's extent.
  error_with_doubles,
};
constexpr ExtentRule extent_rule(TreeKind kind, float share) {
  if (kind == TreeKind::hierarchicalgs) return ExtentRule::longest_side;
  return share == kHalfShare ? ExtentRule::error_with_doubles : ExtentRule::error;
}

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
