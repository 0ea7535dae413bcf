#pragma once
// The payload of a compact chunk: quantised planes in one zstd frame.
#include "runtime/format/chunk_codec.h"

namespace voyager {

// Bytes before compression.
size_t compact_plane_bytes(size_t nodes, size_t coefficients);
// Fills the frame and scale fields of `header`; appends the payload to `out`.
// Returns the largest distance of a restored mean, metres.
double encode_compact(const Chunk& chunk, const ChunkContext& context, ChunkHeader& header,
                      std::vector<std::byte>& out);
// Throws Error(damaged_chunk) where the payload does not decompress to exactly
// compact_plane_bytes(); values are unchecked.
void decode_compact(std::span<const std::byte> payload, const ChunkHeader& header,
                    const ChunkPlace& place, const ChunkContext& context, Chunk& chunk);

}  // namespace voyager
