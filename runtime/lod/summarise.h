#pragma once
// Boxes, extents and merged Gaussians of a tree's nodes.
#include "runtime/lod/baked_scene.h"
#include "runtime/lod/merge.h"

namespace voyager {

struct Box {
  Vec3f least, most;
};

// mean ± 3·max(s), each end rounded once to binary32.
Box leaf_box(const Gaussian& gaussian);

// A node's Gaussian and SH, with the merge weight of METHOD §2.
MergeInput node_gaussian(uint32_t node, const BakedScene& baked);

// A node's Gaussian as an input of its parent's merge. `footprint` is the parent's, in metres²: if
// the node's footprint is larger, the difference is added to the squares of the node's scales. In a
// clustered tree the weight is the node's exposure weight.
MergeInput merge_input(uint32_t node, double footprint, const BakedScene& baked);

// Fills a node's box and extent. For an interior node it also merges the Gaussian from the node's
// children, which must be summarised before. In a clustered tree it fills the exposure too. Nodes
// of one level may be summarised concurrently.
void summarise(uint32_t node, BakedScene& baked);

}  // namespace voyager
