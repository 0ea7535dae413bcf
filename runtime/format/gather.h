#pragma once
#include "runtime/format/chunk.h"
#include "runtime/lod/baked_scene.h"

namespace voyager {

// A chunk of consecutive subtrees of a baked tree, as chunk_codec.h takes it. `first_subtree` is
// the number of the first in the file. A leaf's source_index is its index in `baked.leaves`.
Chunk gather_chunk(const BakedScene& baked, std::span<const Subtree> subtrees,
                   uint32_t first_subtree);

}  // namespace voyager
