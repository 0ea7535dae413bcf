#pragma once
// Nodes with children as every search reads them (runtime/math/bounds_code.h), and what covers
// them.
#include "runtime/base/workers.h"
#include "runtime/lod/subtrees.h"
#include "runtime/lod/tree.h"

namespace voyager {

// Rounds the bounds of all nodes with children. Leaves keep theirs: a search compares no leaf's
// size. A sound tree stays sound, and one that is rounded stays as it is.
void round_bounds(LodTree& tree, Workers& workers);

// A hull that covers the rounded bounds of whatever the given one covers.
EntryHull round_hull(const EntryHull& hull);

}  // namespace voyager
