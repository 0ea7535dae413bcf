#pragma once
#include "runtime/scene/import/block_reader.h"
#include "runtime/scene/import/importer.h"

namespace voyager {

// All that a reader has, in order, from where it stands; not yet sanitised. Memory is taken as
// blocks come, whatever the header announces.
GaussianCloud import_blocks(BlockReader& reader, const ImportOptions& options);

}  // namespace voyager
