#pragma once
// The topology of a cell's tree, whatever built it: child counts of its nodes,
// breadth-first (TreeLayout::child_count).
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/lod/subtrees.h"

namespace voyager {

// Levels of a cell that can lie in a tier whose roots are above the cell.
inline constexpr uint32_t kSharedLevels = kTierLevels - 1;

// The first node of each level, and the number of nodes last. Throws Error(internal) for
// what no cell may be: a node of more than kChildren children, whose subtrees could be
// several; a leaf on the first kSharedLevels levels, since the top has merged Gaussians
// only; counts that do not add up.
std::vector<uint32_t> cell_levels(std::span<const uint8_t> child_count);

// A root with its children and grandchildren, as SiblingRule takes it.
struct RootShape {
  uint8_t nodes : 5, sibling : 1, deep : 1;
};
static_assert(sizeof(RootShape) == 1);

// Of each node on a level.
std::vector<RootShape> root_shapes(std::span<const uint8_t> child_count,
                                   std::span<const uint32_t> levels, uint32_t level);

}  // namespace voyager
