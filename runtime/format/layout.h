#pragma once
// The .voy file, as docs/voy-format.md defines it. The structures are the bytes
// of the file on a little-endian machine, which every target of this project is.
#include <bit>
#include <cstddef>
#include <cstdint>

#include "runtime/lod/subtree_cursor.h"
#include "runtime/scene/further_gaussians.h"
#include "runtime/scene/hier_format.h"

namespace voyager {

static_assert(std::endian::native == std::endian::little);

enum class Quality : uint32_t { lossless = 1, compact = 2 };

// Where chunks start. Those of a lossless file are for mapping and start on a page;
// compact ones are a page or two long, and pages would make a file up to half as long again.
inline constexpr uint64_t chunk_align(Quality quality) {
  return quality == Quality::lossless ? 4096 : 64;  // bytes
}

// Line ends in both habits, so that a transfer in text mode is seen at once.
inline constexpr unsigned char kSceneMagic[8] = {0x89, 'V', 'O', 'Y', '\r', '\n', 0x1a, '\n'};
inline constexpr uint32_t kSceneVersion = 6;
inline constexpr uint32_t kOldestSceneVersion = 4;  // that is read: without what later ones add
// From version 6 on a subtree may have several roots, and says how many.
inline constexpr bool has_root_counts(uint32_t version) {
  return version >= 6;
}
inline constexpr size_t subtree_count_bytes(uint32_t version) {
  return has_root_counts(version) ? 3 : 2;
}
inline constexpr uint32_t kFlagAntialiased = 1;
inline constexpr uint32_t kFlagLeafExtents = 2;  // some leaf's extent is not 0
inline constexpr uint32_t kFlagClustered = 4;    // the rule of the tree (tree_rule.h)
inline constexpr uint32_t kFlagKeptTree = 8;     // a .hier's own: leaf opacities are linear
inline constexpr uint32_t kFlagFurther = 256;    // further Gaussians (further.h) after chunks
// From version 5 on: footprint levels beyond the first (node_code.h).
inline constexpr uint32_t kFootprintShift = 4, kFootprintMask = 0xfu << kFootprintShift;
inline constexpr uint32_t kFlags =
    kFlagAntialiased | kFlagLeafExtents | kFlagClustered | kFlagKeptTree | kFlagFurther;
inline constexpr uint32_t kChunkTag = 0x4b484356;  // "VCHK"

enum class SectionKind : uint32_t { chunk_directory = 1, tiers = 2 };

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
  uint32_t subtree_count;
  uint32_t chunk_bytes;  // of records, at most
  uint32_t first_tier_levels;
  uint32_t section_count;
  Section directory;
  Section tiers;
  float largest_sh;         // |coefficient|, over all that the chunks decode to
  uint32_t left_out_bands;  // of the input, above sh_degree: zero in every Gaussian
  // From version 5 on.
  double native_pixel;     // metres (METHOD §12), of level 0; 0: no footprint
  double low_pass;         // of the pixel filter, pixels²
  uint32_t native_source;  // a NativeSource
  float blend_share;       // METHOD §4's β; before version 5 0.5
  uint64_t checksum;       // XXH3-64 of the header's bytes before this field
};
static_assert(sizeof(FileHeader) == 312 && offsetof(FileHeader, checksum) == 304);

// Bytes of a version's header that its checksum is of; the checksum follows, and ends the header.
inline constexpr size_t checked_header_bytes(uint32_t version) {
  return version == 4 ? offsetof(FileHeader, native_pixel) : offsetof(FileHeader, checksum);
}
inline constexpr size_t header_bytes(uint32_t version) {
  return checked_header_bytes(version) + sizeof(uint64_t);
}

struct ChunkEntry {
  uint64_t offset;    // in the file, a multiple of chunk_align()
  uint64_t checksum;  // XXH3-64 of the stored bytes
  uint32_t bytes;     // stored, padding included: a multiple of chunk_align()
  uint32_t first_subtree;
  uint32_t subtree_count;
  uint32_t node_count;    // that its subtrees own
  uint32_t record_count;  // repeated ones included
  SubtreePlace place;     // of its first subtree
  EntryHull hull;
};
static_assert(sizeof(ChunkEntry) == 88);

struct ChunkHeader {
  uint32_t tag;
  uint32_t first_subtree;
  uint32_t subtree_count;
  uint32_t node_count;
  uint32_t record_count;
  uint16_t quality;
  uint16_t sh_degree;
  uint32_t payload_bytes;  // after this header, before the padding
  // Compact storage; zeros in a lossless chunk.
  float sh_scale[3];  // largest |coefficient| of bands 1, 2, 3
  double position_step[3];
};
static_assert(sizeof(ChunkHeader) == 64);

// Of the section of further Gaussians: two counts, a node, a Gaussian, the checksum.
inline constexpr uint64_t kLeastFurtherBytes =
    8 + sizeof(FurtherCount) + kHierFloats * sizeof(float) + 8;
static_assert(kLeastFurtherBytes == 260);

inline constexpr uint64_t align_up(uint64_t bytes, uint64_t alignment) {
  return (bytes + alignment - 1) / alignment * alignment;
}

}  // namespace voyager
