#pragma once
// How a scene is cut into cells, which follows from the number of Gaussians alone: the
// tree above them is the kd tree of runtime/lod/shape.h, and a cell is what lies below one
// node of it. What is inside a cell is its builder's to decide (cell_tree.h).
#include <algorithm>
#include <cstdint>
#include <vector>

#include "runtime/lod/tree_rule.h"

namespace voyager {

// Least Gaussians of a cell of a clustered tree: whole exposure blocks; all splits above it are
// then full, so that there are kChildren^level cells on a level; and no leaf is on the levels that
// cell_levels() minds (cell_shape.h), which are above the blocks.
constexpr uint32_t least_cell(const TreeRule& rule) {
  return std::max(2 * rule.exposure_block, 64 * rule.block);
}

// The deepest level that cells may be on; 0 where the scene is too small for any.
uint32_t deepest_cell_level(uint32_t gaussians, const TreeRule& rule);

// Gaussians of each cell of a level, in order. level is 1 to deepest_cell_level().
std::vector<uint32_t> cell_sizes(uint32_t gaussians, uint32_t level, const TreeRule& rule);

}  // namespace voyager
