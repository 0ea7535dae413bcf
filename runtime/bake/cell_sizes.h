#pragma once
// How a scene is cut into cells, which follows from the number of Gaussians alone: the
// tree above them is the kd tree of runtime/lod/shape.h, and a cell is what lies below one
// node of it. What is inside a cell is its builder's to decide (cell_tree.h).
#include <cstdint>
#include <vector>

namespace voyager {

// Least Gaussians of a cell: all splits above it are then full, so that there are
// kChildren^level cells on a level, and a tree of kChildren children a node has no leaf
// on the levels that cell_levels() minds (cell_shape.h).
inline constexpr uint32_t kLeastCell = 1024;

// The deepest level that cells may be on; 0 where the scene is too small for any.
uint32_t deepest_cell_level(uint32_t gaussians);

// Gaussians of each cell of a level, in order. level is 1 to deepest_cell_level().
std::vector<uint32_t> cell_sizes(uint32_t gaussians, uint32_t level);

}  // namespace voyager
