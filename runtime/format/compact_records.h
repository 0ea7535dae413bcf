#pragma once
// The records of a compact chunk, to and from the planes at the start of its frame.
#include <functional>

#include "runtime/format/chunk_codec.h"
#include "runtime/format/families.h"

namespace voyager {

// Called with where planes end that share entropy tables: few groups, since a chunk is small, of
// planes that are alike.
using EndGroup = std::function<void(const std::byte* position)>;

// Returns where the planes of the Gaussians start; the last group is not ended.
std::byte* put_records(std::byte* at, const Chunk& chunk, const ChunkCounts& counts,
                       const Families& families, const ChunkContext& context,
                       const EndGroup& end_group);

// From the planes of a chunk with as many subtrees and records; `at` moves past what is taken.
// Any bytes give records, which are still to be checked.
ChunkCounts take_counts(std::byte*& at, const ChunkEntry& entry, uint32_t version);
void take_records(std::byte*& at, const ChunkCounts& counts, const Families& families,
                  ExtentRule rule, Chunk& chunk);

}  // namespace voyager
