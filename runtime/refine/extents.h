#pragma once
#include "runtime/lod/tree.h"
#include "runtime/refine/measured.h"

namespace voyager {

// Moves extents towards what was measured (docs/lod-tree.md), so that none is below its children's.
void set_extents(const Measured& measured, LodTree& tree);

// Raises every extent to its children's greatest.
void never_grow_downwards(LodTree& tree);

}  // namespace voyager
