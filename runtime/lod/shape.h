#pragma once
// The shape of a kd tree: how many children a node over `size` Gaussians has,
// and how many Gaussians each of them. It depends on the size alone.
#include <cstdint>
#include <vector>

#include "runtime/lod/tree_rule.h"

namespace voyager {

struct KdRule {
  uint32_t splits;  // times that a node is halved for its children: 2 at most
  // Gaussians of a node that is not divided; the lower half of one that is has a multiple of them,
  // so that as many nodes as can be are full. 1: plain halving, the larger half above.
  uint32_t block;
  bool boxes;  // halved along the longest side of the Gaussians' boxes, not of their means
};
constexpr KdRule kd_rule(const TreeRule& rule) {
  return rule.kind == TreeKind::hierarchicalgs ? KdRule{1, 1, true} : KdRule{2, rule.block, false};
}

// Gaussians on the lower side of a split of `size`, which exceeds the rule's block.
constexpr uint32_t lower_part(uint32_t size, const KdRule& rule) {
  if (rule.block == 1) return size / 2;
  const uint32_t blocks = size / rule.block + (size % rule.block != 0);
  return rule.block * ((blocks + 1) / 2);
}

// Of a node, at most.
inline constexpr uint32_t kChildren = 4;

struct Parts {
  uint32_t count;
  uint32_t size[kChildren];
};

// Children of a node over `size` Gaussians, more than a block, in order along the splits.
Parts split_in_parts(uint32_t size, const KdRule& rule);

struct Range {
  uint32_t begin, size;
};
// What halving makes of `size` Gaussians, in kd order, where it ends at parts of at most `most`,
// which is no less than the rule's block.
std::vector<Range> parts_of(uint32_t size, uint32_t most, const KdRule& rule);

}  // namespace voyager
