#pragma once
// The tree of one cell, and what the top needs of it.
#include "runtime/bake/cell_rows.h"
#include "runtime/lod/baked_scene.h"

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
  float sh[3 * sh_coefficients(kMaxShDegree)];
};

std::string cell_tree_name(uint32_t cell);

// Sorts and merges a cell; its file then has the layout, and the nodes of the levels that
// are the top's, too.
void build_cell(const SplitInfo& split, const BakePlan& plan, uint32_t cell,
                const WorkFolder& folder, Workers& workers);

// The same tree again, from the layout.
CellTree rebuild_cell(const SplitInfo& split, const BakePlan& plan, uint32_t cell,
                      const WorkFolder& folder, Workers& workers);

// Of the levels that are the top's, too, in order.
std::vector<NodeRow> read_cell_nodes(const BakePlan& plan, uint32_t cell, const WorkFolder& folder);

}  // namespace voyager
