#pragma once
// A cut of a given size, for no viewer in particular.
#include "runtime/base/progress.h"
#include "runtime/format/reader.h"
#include "runtime/lod/baked_scene.h"

namespace voyager {

// The nodes that are drawn where every node with an extent above a threshold is refined, and the
// threshold is the least with which there are at most `most` of them (at least 1). An extent is an
// error (docs/lod-tree.md), so this is the cut that loses the least for its size if all of the
// scene is seen from as near.
//
// As a flat scene, in the order of node ids chunk by chunk: leaves have their words, merged
// Gaussians flat_logit() of their opacity. Positions are relative to the file's origin. Holds the
// cloud, and 12 bytes for each node of the tree. Reads the chunks twice. Throws
// Error(damaged_chunk); Error(refused_input) where the tree does not fit together. Progress stage
// "exporting".
GaussianCloud read_extent_cut(const SceneFile& scene, uint64_t most, const Progress& progress = {});

// The same of a tree in memory, in the order of its node ids.
GaussianCloud extent_cut(const BakedScene& baked, uint64_t most);

}  // namespace voyager
