#pragma once
// The payload of a lossless chunk: raw planes that can be mapped.
#include "runtime/format/chunk_codec.h"

namespace voyager {

size_t lossless_payload_bytes(size_t nodes, size_t coefficients);
void encode_lossless(const Chunk& chunk, std::vector<std::byte>& out);
// payload.size() is lossless_payload_bytes(); chunk.records and the other
// arrays are filled, values unchecked.
void decode_lossless(std::span<const std::byte> payload, size_t nodes, const ChunkContext& context,
                     Chunk& chunk);

}  // namespace voyager
