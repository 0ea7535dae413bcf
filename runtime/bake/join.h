#pragma once
#include "runtime/bake/cell_chunks.h"

namespace voyager {

// Writes the scene from the top and the chunks of all cells. The file appears whole or
// not at all. Progress stage "writing". Throws Error(io), Error(refused_input) where a
// file of the folder was altered.
void join_cells(const SplitInfo& split, const BakePlan& plan, const BakedScene& top,
                Quality quality, const WorkFolder& folder, const std::string& output,
                Workers& workers, const Progress& progress);

}  // namespace voyager
