#pragma once
// Several flat scenes as one.
#include <memory>
#include <vector>

#include "runtime/base/file.h"
#include "runtime/scene/import/block_reader.h"
#include "tools/placement.h"

namespace voyager::tools {

// In their order, each in its place; headers of all are read at once, Gaussians of one at a time.
// At least one. Throws CLI::ValidationError as Placement does, Error(refused_input) as readers and
// merge_blocks() do, and where inputs that are not moved have different origins.
std::unique_ptr<BlockReader> open_joined(
    const std::vector<std::shared_ptr<const ByteSource>>& sources, const Placement& placement);

// Says what of an input is not read (left_out_of()).
void note_left_out(const ByteSource& source);

}  // namespace voyager::tools
