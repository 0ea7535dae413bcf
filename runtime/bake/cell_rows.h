#pragma once
// The Gaussians of each cell in a file of its own, in the input's order: all words, and
// where in the input each was. Also what is known when they are there: the split.
#include "runtime/bake/cell_sizes.h"
#include "runtime/bake/medians.h"
#include "runtime/bake/spool.h"

namespace voyager {

// Of every cell and the whole, after the split.
struct SplitInfo {
  SpoolInfo spool;  // without pieces
  uint32_t cell_level = 0;
  std::vector<uint32_t> cell_sizes;  // Gaussians of each
  std::array<double, 3> origin{0, 0, 0};

  uint32_t cells() const { return static_cast<uint32_t>(cell_sizes.size()); }
};

// Sorts the spooled rows into the files of their cells, in at most `memory` bytes; then
// the file "split" says that it is done, and the spool is removed. Progress stage
// "distributing".
void distribute(const SpoolInfo& spool, const SplitTree& tree, const std::array<double, 3>& origin,
                const WorkFolder& folder, uint64_t memory, Workers& workers,
                const Progress& progress);
SplitInfo read_split_info(const WorkFolder& folder, const TreeRule& rule);

struct CellRows {
  GaussianCloud cloud;            // the input's words
  std::vector<uint32_t> sources;  // of each: its index in the input, ascending
};

// Throws Error(refused_input) where the file was altered.
CellRows read_cell_rows(const SplitInfo& split, uint32_t cell, const WorkFolder& folder);

}  // namespace voyager
