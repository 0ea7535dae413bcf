#pragma once
// The passes that fill a laid-out tree, level by level: boxes and merged Gaussians
// bottom up, then axes top down. A tree may be part of a larger one.
#include <vector>

#include "runtime/base/progress.h"
#include "runtime/base/workers.h"
#include "runtime/lod/baked_scene.h"

namespace voyager {

// Boxes of all nodes and Gaussians of interior ones. Progress stage "merging".
void summarise_levels(const std::vector<uint32_t>& levels, BakedScene& baked, Workers& workers,
                      const Progress& progress = {});

// Turns the axes of every node but the root to its parent's, whose own are final.
// Progress stage "aligning".
void align_levels(const std::vector<uint32_t>& levels, BakedScene& baked, Workers& workers,
                  const Progress& progress = {});

}  // namespace voyager
