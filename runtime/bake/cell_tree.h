#pragma once
// The tree of one cell, and what the plan and the top need of it.
#include "runtime/bake/cell_rows.h"
#include "runtime/lod/layout.h"

namespace voyager {

// Merged, axes not yet turned: those follow from the nodes above the cell.
struct CellTree {
  BakedScene baked;
  std::vector<uint32_t> levels;   // first node of each, and their number
  std::vector<uint32_t> sources;  // of each leaf's Gaussian: its index in the input
};

// The merged Gaussian and the box of a node, to be put into another tree.
struct NodeRow {
  NodeRecord record;
  GaussianWords words;
  Exposure exposure;
  uint32_t code;  // node_code.h
  float sh[3 * sh_coefficients(kMaxShDegree)];
};

// Lays out and merges a cell, and writes its files. Throws Error(internal) for a layout
// that cell_levels() refuses: no clustered tree's.
void build_cell(const SplitInfo& split, uint32_t cell, const TreeRule& rule,
                std::span<const TrainingCamera> cameras, const WorkFolder& folder,
                Workers& workers);

// The same tree again, from its layout.
CellTree rebuild_cell(const SplitInfo& split, uint32_t cell, const WorkFolder& folder,
                      Workers& workers);

// Of the whole cell, breadth-first.
std::vector<uint8_t> read_cell_shape(uint32_t cell, const WorkFolder& folder);

// Of its first kSharedLevels levels, in order.
std::vector<NodeRow> read_cell_nodes(uint32_t cell, const WorkFolder& folder);

}  // namespace voyager
