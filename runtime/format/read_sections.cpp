#include "runtime/format/read_sections.h"

#include "runtime/format/compact_codec.h"
#include "runtime/format/lossless_codec.h"
#include "runtime/format/section_reader.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {
namespace {

// Where each level starts and then where each tier does: both from 0, ascending, up to a count.
void read_tiers(const ByteSource& source, const FileHeader& h, const Check& check,
                FileSections& sections) {
  const uint64_t levels = h.node_count == 0 ? 0 : uint64_t{h.depth} + 1;
  const uint64_t tiers =
      h.node_count == 0 ? 0 : uint64_t{Tiers::count_of(h.depth, h.first_tier_levels)} + 1;
  const uint64_t offset = header_bytes(h.version), count = levels + tiers;
  std::vector<uint32_t> begins;
  SectionReader(source, h.tiers, SectionKind::tiers, offset, align_up(count * sizeof(uint32_t), 8),
                check)
      .each<uint32_t>(count, [&](uint32_t begin, uint64_t i) {
        const bool level = i < levels, first = i == 0 || i == levels;
        const char* what = level ? "first nodes of levels" : "first subtrees of tiers";
        const uint64_t at = offset + (level ? 0 : levels * sizeof(uint32_t));
        check.that(first ? begin == 0 : begin > begins.back(), at, what, "ascending from 0");
        if (i == 1) check.equal(at, "nodes in the first level", begin, 1);
        if (i == levels - 1) check.equal(at, what, begin, h.node_count);
        if (i == count - 1) check.equal(at, what, begin, h.subtree_count);
        begins.push_back(begin);
      });
  const auto end_of_levels = begins.begin() + static_cast<std::ptrdiff_t>(levels);
  sections.tier_begin.assign(end_of_levels, begins.end());
  begins.erase(end_of_levels, begins.end());
  sections.level_begin = std::move(begins);
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
    length = align_up(sizeof(ChunkHeader) + lossless_payload_bytes(e, coefficients, h.version),
                      chunk_align(Quality::lossless));
    if (e.bytes == length) return;
  }
  check.equal(at, "chunk length", e.bytes, length);
}

// However little there is to compress, and whatever ends a block of the frame.
void check_compact_length(const ChunkEntry& e, uint64_t at, const FileHeader& h,
                          const Check& check) {
  const uint64_t planes = compact_plane_bytes(
      e, static_cast<size_t>(sh_coefficients(static_cast<int>(h.sh_degree))), h.version);
  check.at_most(at, "chunk length", e.bytes,
                align_up(sizeof(ChunkHeader) + 2 * planes, chunk_align(Quality::compact)));
}

void check_entry(const ChunkEntry& e, uint64_t at, const FileHeader& h, const Check& check) {
  const auto quality = static_cast<Quality>(h.quality);
  const uint64_t alignment = chunk_align(quality);
  check.that(e.bytes != 0 && e.bytes % alignment == 0, at,
             "a chunk length that is 0 or not a multiple of the alignment", "a multiple");
  check.at_most(at, "bytes of records", e.record_count * uint64_t{sizeof(NodeRecord)},
                h.chunk_bytes);
  check.at_most(at, "subtrees of a chunk", e.subtree_count, e.node_count);
  check.at_most(at, "nodes of a chunk", e.node_count, e.record_count);
  check.that(sound(e.hull), at, "an entry hull out of range", "finite, ordered, below 1e18");
  if (quality == Quality::lossless)
    check_lossless_length(e, at, h, check);
  else
    check_compact_length(e, at, h, check);
}

// Entry by entry: no byte of the file is outside a checksum, and no subtree or node outside a
// chunk.
class DirectoryCheck {
 public:
  DirectoryCheck(const Tiers& tiers, const FileHeader& h, const Check& check)
      : tiers_(tiers),
        header_(h),
        check_(check),
        cursor_(tiers),
        next_(tiers),
        offset_(h.directory.offset + h.directory.length) {}

  void accept(const ChunkEntry& e, uint64_t i) {
    const uint64_t at = header_.directory.offset + i * sizeof(ChunkEntry);
    check_.equal(at, "chunk offset", e.offset, offset_);
    check_.at_most(at, "chunk length", e.bytes, header_.file_length - offset_);
    check_.equal(at, "first subtree", e.first_subtree, subtree_);
    check_entry(e, at, header_, check_);
    check_.that(i > 0 ? next_.move_to(e.first_subtree, e.place) : e.place == next_.place(), at,
                "a first subtree at nodes where none can start", "the nodes that follow");
    check_.that(e.subtree_count != 0 && !next_.at_end(), at, "a chunk without subtrees",
                "at least 1");
    if (i > 0)
      check_.equal(at, "nodes of the chunk before", count_between(tiers_, cursor_.place(), e.place),
                   nodes_);
    cursor_ = next_;
    nodes_ = e.node_count;
    offset_ += e.bytes;
    subtree_ += e.subtree_count;
  }

  void finish() {
    const FileHeader& h = header_;
    if ((h.flags & kFlagFurther) == 0)
      check_.equal(offsetof(FileHeader, file_length), "end of the chunks", offset_, h.file_length);
    else
      check_.that(h.file_length - offset_ >= kLeastFurtherBytes, offset_,
                  "too little room for further Gaussians", "at least 260 bytes");
    check_.equal(offsetof(FileHeader, subtree_count), "subtrees in all chunks", subtree_,
                 h.subtree_count);
    if (subtree_ == 0) return;
    next_.move_to(h.subtree_count, SubtreePlace::end_of(tiers_));
    check_.equal(offsetof(FileHeader, node_count), "nodes of the last chunk",
                 count_between(tiers_, cursor_.place(), next_.place()), nodes_);
  }

 private:
  const Tiers tiers_;
  const FileHeader& header_;
  const Check& check_;
  SubtreeCursor cursor_, next_;  // at the last entry's first subtree
  uint64_t offset_, subtree_ = 0;
  uint32_t nodes_ = 0;  // of the last entry
};

void read_directory(const ByteSource& source, const FileHeader& h, const Check& check,
                    FileSections& sections) {
  const uint64_t used = h.chunk_count * uint64_t{sizeof(ChunkEntry)};
  const uint64_t offset = h.tiers.offset + h.tiers.length;
  const uint64_t end = align_up(offset + used, chunk_align(static_cast<Quality>(h.quality)));
  DirectoryCheck directory({h.first_tier_levels, sections.level_begin, sections.tier_begin}, h,
                           check);
  SectionReader(source, h.directory, SectionKind::chunk_directory, offset, end - offset, check)
      .each<ChunkEntry>(h.chunk_count, [&](const ChunkEntry& entry, uint64_t i) {
        directory.accept(entry, i);
        sections.chunks.add(entry);
      });
  directory.finish();
  sections.chunks.close();
}

}  // namespace

FileSections read_sections(const ByteSource& source, const FileHeader& h, const Check& check) {
  FileSections sections;
  check.equal(offsetof(FileHeader, section_count), "section count", h.section_count, 2);
  read_tiers(source, h, check, sections);
  read_directory(source, h, check, sections);
  return sections;
}

}  // namespace voyager
