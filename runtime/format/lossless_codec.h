#pragma once
// The payload of a lossless chunk: raw planes that can be mapped.
#include "runtime/format/chunk_codec.h"

namespace voyager {

// Of a chunk with the counts of `entry`, in a file of that version.
uint64_t lossless_payload_bytes(const ChunkEntry& entry, size_t coefficients, uint32_t version);
// Appends the payload to out.bytes, and sets out.largest_sh.
void encode_lossless(const Chunk& chunk, const ChunkContext& context, EncodedChunk& out);
// payload.size() is lossless_payload_bytes(). Fills the chunk: subtrees are checked
// (Error(damaged_chunk)), words are not.
void decode_lossless(std::span<const std::byte> payload, const ChunkLocation& location,
                     const ChunkContext& context, Chunk& chunk);

}  // namespace voyager
