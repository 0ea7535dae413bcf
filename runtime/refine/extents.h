#pragma once
#include "runtime/lod/tree.h"
#include "runtime/refine/measured.h"

namespace voyager {

// Moves extents towards what was measured (docs/lod-tree.md), so that none is below its children's.
void set_extents(const Measured& measured, LodTree& tree);

}  // namespace voyager
