#pragma once
#include "runtime/base/workers.h"
#include "runtime/lod/tree.h"

namespace voyager {

// Rounds the bounds of all nodes with children to what every search reads of them
// (runtime/math/bounds_code.h). Leaves keep theirs: a search compares no leaf's size. A sound tree
// stays sound, and one that is rounded stays as it is.
void round_bounds(LodTree& tree, Workers& workers);

}  // namespace voyager
