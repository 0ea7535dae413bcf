#include "runtime/format/read_sections.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/base/checksum.h"
#include "runtime/format/lossless_codec.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {
namespace {

std::vector<std::byte> read_section(const ByteSource& source, const Section& section,
                                    SectionKind kind, uint64_t offset, uint64_t length,
                                    const Check& check) {
  const uint64_t at = offsetof(FileHeader, section_count);
  check.equal(at, "section kind", section.kind, static_cast<uint32_t>(kind));
  check.equal(at, "reserved field", section.reserved, 0);
  check.equal(at, "section offset", section.offset, offset);
  check.equal(at, "section length", section.length, length);
  check.at_most(at, "section end", offset + length, source.size());
  std::vector<std::byte> bytes(length);
  source.read(offset, bytes);
  check.equal(offset, "section checksum", checksum(bytes), section.checksum);
  return bytes;
}

void check_padding(const std::vector<std::byte>& bytes, uint64_t used, uint64_t offset,
                   const Check& check) {
  check.that(std::all_of(bytes.begin() + static_cast<std::ptrdiff_t>(used), bytes.end(),
                         [](std::byte b) { return b == std::byte{0}; }),
             offset + used, "padding that is not 0", "zeros");
}

// From 0, ascending, up to `end`.
void check_begins(const std::vector<uint32_t>& begin, uint64_t at, const char* what, uint32_t end,
                  const Check& check) {
  const bool ascending =
      std::adjacent_find(begin.begin(), begin.end(), std::greater_equal<>()) == begin.end();
  check.that(ascending && begin.front() == 0, at, what, "ascending from 0");
  check.equal(at, what, begin.back(), end);
}

void read_tiers(const ByteSource& source, const FileHeader& h, const Check& check,
                FileSections& sections) {
  const uint32_t tiers = Tiers::count_of(h.depth, h.first_tier_levels);
  const size_t levels = h.node_count == 0 ? 0 : size_t{h.depth} + 1,
               begins = h.node_count == 0 ? 0 : size_t{tiers} + 1;
  const size_t used = (levels + begins) * sizeof(uint32_t);
  const uint64_t offset = sizeof(FileHeader);
  const std::vector<std::byte> bytes =
      read_section(source, h.tiers, SectionKind::tiers, offset, align_up(used, 8), check);
  check_padding(bytes, used, offset, check);
  if (h.node_count == 0) return;
  sections.level_begin.resize(levels);
  sections.tier_begin.resize(begins);
  std::memcpy(sections.level_begin.data(), bytes.data(), levels * sizeof(uint32_t));
  std::memcpy(sections.tier_begin.data(), bytes.data() + levels * sizeof(uint32_t),
              begins * sizeof(uint32_t));
  check_begins(sections.level_begin, offset, "first nodes of levels", h.node_count, check);
  check.equal(offset, "nodes in the first level", sections.level_begin[1], 1);
  check_begins(sections.tier_begin, offset + levels * sizeof(uint32_t), "first subtrees of tiers",
               h.subtree_count, check);
}

// Comparisons are written so that a NaN fails.
bool sound(const EntryHull& hull) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(hull.box_min[axis] > -kMaxCoordinate && hull.box_min[axis] <= hull.box_max[axis] &&
          hull.box_max[axis] < kMaxCoordinate))
      return false;
  return hull.extent >= 0;
}

// Of any SH degree up to the file's: which one it is, the chunk says.
void check_lossless_length(const ChunkEntry& e, uint64_t at, const FileHeader& h,
                           const Check& check) {
  uint64_t length = 0;
  for (int degree = 0; degree <= static_cast<int>(h.sh_degree); ++degree) {
    const auto coefficients = static_cast<size_t>(sh_coefficients(degree));
    length = align_up(sizeof(ChunkHeader) + lossless_payload_bytes(e, coefficients),
                      chunk_align(Quality::lossless));
    if (e.bytes == length) return;
  }
  check.equal(at, "chunk length", e.bytes, length);
}

void check_entry(const ChunkEntry& e, uint64_t at, const FileHeader& h, const Check& check) {
  const auto quality = static_cast<Quality>(h.quality);
  const uint64_t alignment = chunk_align(quality);
  check.that(e.bytes != 0 && e.bytes % alignment == 0, at,
             "a chunk length that is 0 or not a multiple of the alignment", "a multiple");
  check.at_most(at, "bytes of search records", e.record_count * uint64_t{sizeof(NodeRecord)},
                h.chunk_bytes);
  check.at_most(at, "subtrees of a chunk", e.subtree_count, e.record_count);
  check.at_most(at, "nodes of a chunk", e.node_count, e.record_count);
  check.that(sound(e.hull), at, "an entry hull out of range", "finite, ordered, below 1e18");
  if (quality == Quality::lossless) check_lossless_length(e, at, h, check);
}

uint64_t count_nodes(const Tiers& tiers, const SubtreePlace& from, const SubtreePlace& to) {
  uint64_t nodes = 0;
  for (const NodeRange& range : nodes_between(tiers, from, to)) nodes += range.count;
  return nodes;
}

// No byte of the file is outside a checksum, and no subtree or node outside a chunk.
void check_directory(const FileSections& sections, const FileHeader& h, const Check& check) {
  const Tiers tiers{h.first_tier_levels, sections.level_begin, sections.tier_begin};
  SubtreeCursor cursor(tiers), next(tiers);
  uint64_t offset = h.directory.offset + h.directory.length, subtree = 0;
  const std::vector<ChunkEntry>& chunks = sections.chunks;
  for (size_t i = 0; i < chunks.size(); ++i) {
    const ChunkEntry& e = chunks[i];
    const uint64_t at = h.directory.offset + i * sizeof(ChunkEntry);
    check.equal(at, "chunk offset", e.offset, offset);
    check.at_most(at, "chunk length", e.bytes, h.file_length - offset);
    check.equal(at, "first subtree", e.first_subtree, subtree);
    check_entry(e, at, h, check);
    check.that(i > 0 ? next.move_to(e.first_subtree, e.place) : e.place == next.place(), at,
               "a first subtree at nodes where none can start", "the nodes that follow");
    check.that(e.subtree_count != 0 && !next.at_end(), at, "a chunk without subtrees",
               "at least 1");
    if (i > 0)
      check.equal(at, "nodes of the chunk before", count_nodes(tiers, cursor.place(), e.place),
                  chunks[i - 1].node_count);
    cursor = next;
    offset += e.bytes;
    subtree += e.subtree_count;
  }
  check.equal(offsetof(FileHeader, file_length), "end of the chunks", offset, h.file_length);
  check.equal(offsetof(FileHeader, subtree_count), "subtrees in all chunks", subtree,
              h.subtree_count);
  if (chunks.empty()) return;
  next.move_to(h.subtree_count, SubtreePlace::end_of(tiers));
  check.equal(offsetof(FileHeader, node_count), "nodes of the last chunk",
              count_nodes(tiers, cursor.place(), next.place()), chunks.back().node_count);
}

}  // namespace

FileSections read_sections(const ByteSource& source, const FileHeader& h, const Check& check) {
  FileSections sections;
  check.equal(offsetof(FileHeader, section_count), "section count", h.section_count, 2);
  read_tiers(source, h, check, sections);
  const uint64_t used = h.chunk_count * uint64_t{sizeof(ChunkEntry)};
  const uint64_t offset = h.tiers.offset + h.tiers.length;
  const uint64_t end = align_up(offset + used, chunk_align(static_cast<Quality>(h.quality)));
  const std::vector<std::byte> bytes =
      read_section(source, h.directory, SectionKind::chunk_directory, offset, end - offset, check);
  check_padding(bytes, used, offset, check);
  sections.chunks.resize(h.chunk_count);
  if (h.chunk_count != 0) std::memcpy(sections.chunks.data(), bytes.data(), used);
  check_directory(sections, h, check);
  return sections;
}

}  // namespace voyager
