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
  float sh[3 * sh_coefficients(kMaxShDegree)];
};

// Child counts and topmost nodes of a cell: what all cells need of each other. It is
// written last: a cell that has it is built.
std::string cell_tree_name(uint32_t cell);
// The rest of the layout: which Gaussian each leaf is, and how it shows.
std::string cell_leaves_name(uint32_t cell);

// Lays out and merges a cell, and writes its files. Throws Error(internal) for a layout
// that cell_levels() refuses: no clustered tree's.
void build_cell(const SplitInfo& split, uint32_t cell, const TreeRule& rule,
                const WorkFolder& folder, Workers& workers);

// The same tree again, from its layout.
CellTree rebuild_cell(const SplitInfo& split, uint32_t cell, const WorkFolder& folder,
                      Workers& workers);

// Of the whole cell, breadth-first.
std::vector<uint8_t> read_cell_shape(uint32_t cell, const WorkFolder& folder);

// Of its first kSharedLevels levels, in order.
std::vector<NodeRow> read_cell_nodes(uint32_t cell, const WorkFolder& folder);

}  // namespace voyager
