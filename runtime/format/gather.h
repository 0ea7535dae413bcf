#pragma once
#include "runtime/format/chunk.h"
#include "runtime/lod/baked_scene.h"

namespace voyager {

// Consecutive subtrees of a baked tree as the codec takes them. first_subtree is what
// the chunk shall say of the first; its leaves' sources are their indices in the cloud.
Chunk gather_chunk(const BakedScene& baked, std::span<const Subtree> subtrees,
                   uint32_t first_subtree);

}  // namespace voyager
