#pragma once
// One chunk to and from its stored bytes (docs/voy-format.md, "A chunk").
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/format/chunk.h"
#include "runtime/format/layout.h"
#include "runtime/lod/tree_rule.h"

namespace voyager {

// What a chunk shares with its file.
struct ChunkContext {
  Quality quality = Quality::lossless;
  int sh_degree = 0;
  Vec3d origin{0, 0, 0}, source_origin{0, 0, 0};
  uint32_t leaf_count = 0;
  Tiers tiers;
  ExtentRule extents = ExtentRule::error;
  uint32_t version = kSceneVersion;
  // What a decoded chunk must keep to; an encoder reads none of it.
  float largest_sh = 0;             // no |coefficient| is larger
  bool leaves_have_extent = false;  // else every leaf's extent is 0
  int footprint_levels = 1;         // no node's level is as high
  bool linear_leaves = false;       // Chunk::linear_leaves

  size_t coefficients() const {
    const auto n = static_cast<size_t>(sh_degree) + 1;
    return n * n;
  }
};

struct EncodedChunk {
  std::vector<std::byte> bytes;  // header, payload, zeros up to a multiple of chunk_align()
  uint64_t checksum = 0;         // XXH3-64 of bytes
  double position_error = 0;     // largest distance of a restored mean, metres; lossless 0
  float largest_sh = 0;          // |coefficient| as it is restored
  bool leaves_have_extent = false;
};

// The chunk's arrays are complete and finite; node and first_child are not read. SH bands above
// the highest that is not +0 throughout the chunk are not stored, and are +0 as they are decoded.
EncodedChunk encode_chunk(const Chunk& chunk, const ChunkContext& context);

// What the directory says of a chunk, and where: for messages.
struct ChunkLocation {
  const std::string& file;
  uint32_t index;
  const ChunkEntry& entry;
  SubtreePlace next;  // of the next chunk; the end after the last

  // Throws Error(damaged_chunk) naming file, chunk, offset, found, expected.
  [[noreturn]] void damaged(const std::string& found, const std::string& expected) const;
};

// Checks everything that a chunk alone can show to be wrong, and decodes it.
// Memory is bounded by the counts of location.entry, whose place a cursor can move to.
// Throws Error(damaged_chunk).
Chunk decode_chunk(std::span<const std::byte> bytes, const ChunkLocation& location,
                   const ChunkContext& context);

}  // namespace voyager
