#pragma once
// One chunk to and from its stored bytes (docs/voy-format.md, "A chunk").
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/format/chunk.h"
#include "runtime/format/layout.h"

namespace voyager {

// What a chunk shares with its file.
struct ChunkContext {
  Quality quality = Quality::lossless;
  int sh_degree = 0;
  Vec3d origin{0, 0, 0}, source_origin{0, 0, 0};
  uint32_t leaf_count = 0;

  size_t coefficients() const {
    const auto n = static_cast<size_t>(sh_degree) + 1;
    return n * n;
  }
};

struct EncodedChunk {
  std::vector<std::byte> bytes;  // header, payload, zeros up to a multiple of kChunkAlign
  uint64_t checksum = 0;         // XXH3-64 of bytes
  double position_error = 0;     // largest distance of a restored mean, metres; lossless 0
};

// The chunk's arrays are complete and finite.
EncodedChunk encode_chunk(const Chunk& chunk, const ChunkContext& context);

// What the directory says of a chunk, and where: for messages.
struct ChunkPlace {
  const std::string& file;
  uint32_t index;
  uint64_t offset;
  uint32_t first_node, node_count, first_child;
  uint32_t next_first_child;  // of the next chunk; the node count after the last

  // Throws Error(damaged_chunk) naming file, chunk, offset, found, expected.
  [[noreturn]] void damaged(const std::string& found, const std::string& expected) const;
};

// Checks everything that a chunk alone can show to be wrong, and decodes it.
// Memory is bounded by place.node_count. Throws Error(damaged_chunk).
Chunk decode_chunk(std::span<const std::byte> bytes, uint64_t expected_checksum,
                   const ChunkPlace& place, const ChunkContext& context);

}  // namespace voyager
