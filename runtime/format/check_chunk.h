#pragma once
#include "runtime/format/chunk_codec.h"

namespace voyager {

// The values of a decoded chunk: boxes, extents, child counts, leaves, axis
// codes and words in the ranges that everything downstream relies on. Throws
// Error(damaged_chunk) naming the first node that is wrong.
void check_chunk(const Chunk& chunk, const ChunkPlace& place, const ChunkContext& context);

}  // namespace voyager
