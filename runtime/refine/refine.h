#pragma once
// Extents from what refining is seen to gain (docs/lod-tree.md): the scene is looked at from many
// places, its cuts beside all leaves.
#include <cstdint>
#include <string>

#include "runtime/base/progress.h"
#include "runtime/base/workers.h"
#include "runtime/lod/baked_scene.h"

namespace voyager {

// Changes the extents of a clustered tree, and nothing else; they never grow downwards. The same
// scene and views give the same extents, whatever the number of threads and however often this was
// stopped.
// views: places, at least 1. kept: a file in which what was measured is kept now and then, and from
// which this goes on; whoever calls removes it. Progress counts views.
// Throws Error(refused_input) where the file is of another scene, of more views, or was altered,
// Error(unsupported) for another kind of tree, Error(io).
void refine_extents(BakedScene& baked, uint32_t views, const std::string& kept, Workers& workers,
                    const Progress& progress = {});

// Bytes that this takes beside the scene, about (district: 314 a Gaussian).
constexpr uint64_t bytes_to_refine(uint64_t gaussians) {
  return 400 * gaussians;
}

}  // namespace voyager
