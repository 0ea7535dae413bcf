#pragma once
// The .voy file, as docs/voy-format.md defines it. The structures are the bytes
// of the file on a little-endian machine, which every target of this project is.
#include <bit>
#include <cstddef>
#include <cstdint>

namespace voyager {

static_assert(std::endian::native == std::endian::little);

enum class Quality : uint32_t { lossless = 1, compact = 2 };

// Nodes a chunk, the last may hold fewer. Readers refuse more: it bounds the
// memory that one chunk may ask for.
inline constexpr uint32_t kChunkNodes = 1024;
inline constexpr uint64_t kChunkAlign = 4096;  // bytes

// Line ends in both habits, so that a transfer in text mode is seen at once.
inline constexpr unsigned char kSceneMagic[8] = {0x89, 'V', 'O', 'Y', '\r', '\n', 0x1a, '\n'};
inline constexpr uint32_t kSceneVersion = 1;
inline constexpr uint32_t kFlagAntialiased = 1;
inline constexpr uint32_t kChunkTag = 0x4b484356;  // "VCHK"

enum class SectionKind : uint32_t { chunk_directory = 1 };

struct Section {
  uint32_t kind;
  uint32_t reserved;  // 0
  uint64_t offset;
  uint64_t length;
  uint64_t checksum;  // XXH3-64 of the section's bytes
};
static_assert(sizeof(Section) == 32);

struct FileHeader {
  unsigned char magic[8];
  uint32_t version;
  uint32_t flags;
  uint64_t file_length;
  uint32_t quality;
  uint32_t sh_degree;
  uint32_t node_count;
  uint32_t leaf_count;
  uint32_t chunk_count;
  uint32_t depth;
  double origin[3];
  double source_origin[3];
  float bounds_min[3];
  float bounds_max[3];
  double position_error;
  uint64_t import_read;
  uint64_t dropped_position;
  uint64_t dropped_scale;
  uint64_t repaired_scale;
  uint64_t repaired_rotation;
  uint64_t repaired_opacity;
  uint64_t dropped_opacity;
  uint64_t repaired_sh;
  uint32_t section_count;
  uint32_t reserved;  // 0
  Section directory;
  uint64_t checksum;  // XXH3-64 of the header's bytes before this field
};
static_assert(sizeof(FileHeader) == 240 && offsetof(FileHeader, checksum) == 232);

struct ChunkEntry {
  uint64_t offset;  // in the file, a multiple of kChunkAlign
  uint32_t bytes;   // stored, padding included: a multiple of kChunkAlign
  uint32_t first_node;
  uint32_t node_count;
  uint32_t first_child;
  uint64_t checksum;  // XXH3-64 of the stored bytes
};
static_assert(sizeof(ChunkEntry) == 32);

struct ChunkHeader {
  uint32_t tag;
  uint32_t first_node;
  uint32_t node_count;
  uint32_t first_child;
  uint32_t quality;
  uint32_t sh_degree;
  uint32_t payload_bytes;  // after this header, before the padding
  uint32_t reserved;       // 0
  // Compact storage; zeros in a lossless chunk.
  double position_min[3];
  double position_step[3];
  float sh_scale[3];   // largest |coefficient| of bands 1, 2, 3
  uint32_t reserved2;  // 0
};
static_assert(sizeof(ChunkHeader) == 96);

inline constexpr uint64_t align_to_chunk(uint64_t bytes) {
  return (bytes + kChunkAlign - 1) / kChunkAlign * kChunkAlign;
}

// The directory follows the header and is padded to where the first chunk starts.
inline constexpr uint64_t chunks_start(uint64_t chunk_count) {
  return align_to_chunk(sizeof(FileHeader) + chunk_count * sizeof(ChunkEntry));
}

}  // namespace voyager
