#pragma once
// The levels above the cells, and those of the cells that the file has among them.
#include "runtime/bake/cell_tree.h"
#include "runtime/bake/plan.h"

namespace voyager {

// Node ids are the whole tree's. Merged Gaussian i is node i's; there are no leaves.
// Axes are turned: every node is as the file will have it.
BakedScene build_top(const SplitInfo& split, const BakePlan& plan, const WorkFolder& folder,
                     Workers& workers);

// The record of the parent of a cell's root.
const NodeRecord& record_above(const BakedScene& top, const BakePlan& plan, uint32_t cell);

// Turns a cell's axes from its root, whose own the top has turned.
void align_cell(const BakedScene& top, const BakePlan& plan, uint32_t cell, CellTree& tree,
                Workers& workers);

}  // namespace voyager
