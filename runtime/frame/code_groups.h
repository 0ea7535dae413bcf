#pragma once
// Where the scales of codes are of a compact scene whose chunks are all there: a chunk has several
// runs of node ids, each of which is a group (runtime/math/code_groups.h).
#include "runtime/format/reader.h"
#include "runtime/frame/scene.h"

namespace voyager {

// Finds the runs, and makes room for their scales. What an unsound file leaves out is of the run
// before it.
void find_code_groups(const SceneFile& file, Scene& scene);
// Those of a chunk that was read. Chunks of a sound file at once.
void set_code_scales(const SceneFile& file, uint32_t index, const Chunk& chunk, Scene& scene);

}  // namespace voyager
