#pragma once
// Files of a few bytes that claim millions of nodes, under checksums that are right. What stands
// behind the bytes here, up to the length that they name, is for a test to make: zeros, mostly.
#include <string>

#include "runtime/format/compact_codec.h"
#include "runtime/format/lossless_codec.h"
#include "runtime/format/scene_header.h"
#include "tests/support/sealed.h"

namespace voyager::test {

struct ClaimedFile {
  Bytes head;
  uint64_t length = 0;
};

// A root and its leaves, in chunks of the most nodes that there can be; the compact ones have no
// more bytes than their headers.
inline ClaimedFile claimed_chunks(Quality quality, uint32_t chunks) {
  const uint32_t records = kMaxChunkBytes / sizeof(NodeRecord), leaves = records - 1;
  const uint32_t nodes = 1 + chunks * leaves, subtrees = records / kSubtreeNodes;
  const std::vector<uint32_t> levels{0, 1, nodes}, tiers{0, chunks * subtrees};
  SceneTotals totals;
  totals.quality = quality;
  totals.leaf_count = nodes - 1;
  totals.chunk_bytes = kMaxChunkBytes;
  totals.tiers = {2, levels, tiers};
  ClaimedFile file{{}, bytes_before_chunks(totals.tiers, chunks, quality)};
  std::vector<ChunkEntry> entries;
  for (uint32_t i = 0; i < chunks; ++i) {
    ChunkEntry e{};
    e.offset = file.length;
    e.first_subtree = i * subtrees;
    e.subtree_count = subtrees;
    e.node_count = leaves + (i == 0 ? 1 : 0);
    e.record_count = records;
    e.place = {{i == 0 ? 0u : 1u, 1 + i * leaves, nodes, nodes}, i * leaves, 0};
    e.hull = {{0, 0, 0}, 1, {1, 1, 1}};
    const uint64_t payload =
        quality == Quality::compact ? 0 : lossless_payload_bytes(e, 1, kSceneVersion);
    e.bytes = static_cast<uint32_t>(align_up(sizeof(ChunkHeader) + payload, chunk_align(quality)));
    file.length += e.bytes;
    entries.push_back(e);
  }
  file.head = encode_head(totals, entries, file.length);
  return file;
}

// A header whose tiers, or whose directory, take as many bytes as a file may have in all.
inline ClaimedFile claimed_section(SectionKind which, uint64_t length) {
  Bytes head = claimed_chunks(Quality::compact, 1).head;
  FileHeader h;
  std::memcpy(&h, head.data(), sizeof h);
  const bool tiers = which == SectionKind::tiers;
  const auto items =
      static_cast<uint32_t>(length / (tiers ? sizeof(uint32_t) : sizeof(ChunkEntry)));
  h.node_count = h.leaf_count = h.subtree_count = items;
  if (tiers) {
    h.depth = items / 2;
    h.first_tier_levels = 1;
    h.tiers.length = align_up(
        (h.depth + 2 + uint64_t{Tiers::count_of(h.depth, h.first_tier_levels)}) * sizeof(uint32_t),
        8);
    h.directory.offset = h.tiers.offset + h.tiers.length;
  } else {
    std::memcpy(head.data() + h.tiers.offset + 2 * sizeof(uint32_t), &items, sizeof items);
    std::memcpy(head.data() + h.tiers.offset + 4 * sizeof(uint32_t), &items, sizeof items);
    h.chunk_count = items;
  }
  h.directory.length =
      align_up(h.directory.offset + h.chunk_count * uint64_t{sizeof(ChunkEntry)}, 64) -
      h.directory.offset;
  h.file_length = h.directory.offset + h.directory.length + 64;
  std::memcpy(head.data(), &h, sizeof h);
  head = sealed(std::move(head));
  std::memcpy(&h, head.data(), sizeof h);
  h.file_length = h.directory.offset + h.directory.length + 64;
  h.checksum = checksum(std::as_bytes(std::span(&h, 1)).first(offsetof(FileHeader, checksum)));
  std::memcpy(head.data(), &h, sizeof h);
  return {std::move(head), h.file_length};
}

// A .ply whose rows are wide: of so many columns that nobody asked for, and one byte of rows.
inline std::string wide_ply(size_t columns) {
  std::string text = "ply\nformat binary_little_endian 1.0\nelement vertex 1000000\n";
  for (const char* name : {"x", "y", "z", "f_dc_0", "f_dc_1", "f_dc_2", "opacity", "scale_0",
                           "scale_1", "scale_2", "rot_0", "rot_1", "rot_2", "rot_3"})
    text += std::string("property float ") + name + "\n";
  for (size_t i = 0; i < columns; ++i) text += "property double " + std::to_string(i) + "\n";
  return text + "end_header\n!";
}

}  // namespace voyager::test
