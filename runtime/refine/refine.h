#pragma once
// Extents from what refining is seen to gain (docs/lod-tree.md): the scene is looked at from many
// places, its cuts beside all leaves.
#include <string>

#include "runtime/base/progress.h"
#include "runtime/base/workers.h"
#include "runtime/lod/baked_scene.h"

namespace voyager {

// Changes the extents of a clustered tree, and nothing else: they stay in the middle what they
// were, and never grow downwards. The same scene and views give the same extents, whatever the
// number of threads and however often this was stopped.
// views: places, at least 1. kept: a file in which what was measured is kept now and then, and from
// which this goes on, where no more views were taken than are asked for; whoever calls removes it.
// Progress counts views.
// Takes, beside the scene, some 130 bytes a node and what the splats of two pictures take.
// Throws Error(refused_input) where the file is of another scene or was altered, Error(io).
void refine_extents(BakedScene& baked, uint32_t views, const std::string& kept, Workers& workers,
                    const Progress& progress = {});

}  // namespace voyager
