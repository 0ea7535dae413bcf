#pragma once
// The payload of a compact chunk: quantised planes, compressed.
#include "runtime/format/chunk_codec.h"

namespace voyager {

// Of a chunk with the counts of `entry`, in a file of that version: its planes, before they are
// compressed.
uint64_t compact_plane_bytes(const ChunkEntry& entry, size_t coefficients, uint32_t version);
// Fills the frame and scale fields of `header`, whose counts are set; appends the
// payload to out.bytes, and sets what out says of the restored values.
void encode_compact(const Chunk& chunk, const ChunkContext& context, ChunkHeader& header,
                    EncodedChunk& out);
// Fills the chunk: subtrees are checked, words are not. Throws Error(damaged_chunk),
// also where the payload does not decompress to what the counts of `location` take.
void decode_compact(std::span<const std::byte> payload, const ChunkHeader& header,
                    const ChunkLocation& location, const ChunkContext& context, Chunk& chunk);
// Rounds the means of a decoded chunk, which were checked, to its grid (runtime/math/mean_code.h).
void round_means(Chunk& chunk);

}  // namespace voyager
