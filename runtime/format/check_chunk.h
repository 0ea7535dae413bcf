#pragma once
#include "runtime/format/chunk_codec.h"

namespace voyager {

// The subtrees of a chunk whose records are decoded, from their counts. Fills subtrees,
// node, record and first_child. Throws Error(damaged_chunk) naming the first record or
// subtree that is wrong, or where they end elsewhere than at the next chunk.
void link_subtrees(std::span<const SubtreeCounts> counts, const ChunkLocation& location,
                   const ChunkContext& context, Chunk& chunk);

// The Gaussians of a decoded chunk: sources, axis codes and words in the ranges that
// everything downstream relies on. Throws Error(damaged_chunk) naming the first
// node that is wrong.
void check_words(const Chunk& chunk, const ChunkLocation& location, const ChunkContext& context);

}  // namespace voyager
