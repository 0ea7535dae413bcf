#pragma once
#include "runtime/lod/baked_scene.h"
#include "runtime/lod/merge.h"

namespace voyager {

struct Box {
  Vec3f least, most;
};

// mean ± 3·max(s), each end rounded once to binary32.
Box leaf_box(const Gaussian& gaussian);

// The Gaussian of a node as it is drawn, with its SH.
MergeInput node_gaussian(uint32_t node, const BakedScene& baked);

// The same as a parent with that footprint (metres², no larger than the node's) is merged from it:
// with what it weighs, and what its own footprint has more in its scales, so that nothing of it is
// lost.
MergeInput merge_input(uint32_t node, double footprint, const BakedScene& baked);

// Fills a node's box and extent, and an interior node's Gaussian, from its
// children, which are done. Of a clustered tree also its exposure. Nodes of one level may be done
// at once.
void summarise(uint32_t node, BakedScene& baked);

}  // namespace voyager
