#include "runtime/format/reader.h"

#include <cmath>
#include <cstring>

#include "runtime/base/checksum.h"
#include "runtime/base/error.h"
#include "runtime/format/chunk_codec.h"
#include "runtime/format/lossless_codec.h"
#include "runtime/scene/sanitise.h"

namespace voyager {
namespace {

// Refusals name the file and the byte where it went wrong.
class Check {
 public:
  explicit Check(const ByteSource& source) : source_(source) {}

  [[noreturn]] void refuse(uint64_t offset, const std::string& found,
                           const std::string& expected) const {
    throw Error(ErrorCode::refused_input, source_.name() + ": offset " + std::to_string(offset) +
                                              ": found " + found + ", expected " + expected);
  }
  void equal(uint64_t offset, const char* field, uint64_t found, uint64_t expected) const {
    if (found != expected)
      refuse(offset, std::string(field) + " " + std::to_string(found), std::to_string(expected));
  }
  void at_most(uint64_t offset, const char* field, uint64_t found, uint64_t most) const {
    if (found > most)
      refuse(offset, std::string(field) + " " + std::to_string(found),
             "at most " + std::to_string(most));
  }
  void that(bool holds, uint64_t offset, const char* found, const char* expected) const {
    if (!holds) refuse(offset, found, expected);
  }

 private:
  const ByteSource& source_;
};

FileHeader read_header(const ByteSource& source, const Check& check) {
  FileHeader h;
  if (source.size() < sizeof h)
    check.refuse(0, std::to_string(source.size()) + " bytes",
                 "a header of " + std::to_string(sizeof h));
  std::byte bytes[sizeof h];
  source.read(0, bytes);
  check.that(SceneFile::is_scene_file(bytes), 0, "another signature", "that of a .voy file");
  std::memcpy(&h, bytes, sizeof h);
  check.equal(offsetof(FileHeader, version), "version", h.version, kSceneVersion);
  check.equal(offsetof(FileHeader, file_length), "a file of length", source.size(), h.file_length);
  check.equal(offsetof(FileHeader, checksum), "header checksum",
              checksum(std::span(bytes).first(offsetof(FileHeader, checksum))), h.checksum);
  return h;
}

void check_counts(const FileHeader& h, const Check& check) {
  check.at_most(offsetof(FileHeader, flags), "flags", h.flags, kFlagAntialiased);
  check.that(h.quality == 1 || h.quality == 2, offsetof(FileHeader, quality), "an unknown quality",
             "1 or 2");
  check.at_most(offsetof(FileHeader, sh_degree), "SH degree", h.sh_degree, kMaxShDegree);
  check.at_most(offsetof(FileHeader, node_count), "node count", h.node_count, kNoNode - 1);
  check.at_most(offsetof(FileHeader, leaf_count), "leaf count", h.leaf_count, h.node_count);
  check.at_most(offsetof(FileHeader, depth), "depth", h.depth, h.node_count);
  check.that((h.node_count == 0) == (h.leaf_count == 0) && (h.node_count == 0) == (h.depth == 0),
             offsetof(FileHeader, node_count), "counts of which only some are 0", "all or none");
  check.equal(offsetof(FileHeader, reserved), "reserved field", h.reserved, 0);
}

void check_places(const FileHeader& h, const Check& check) {
  for (int axis = 0; axis < 3; ++axis) {
    check.that(std::fabs(h.origin[axis]) < double{kMaxCoordinate} &&
                   std::fabs(h.source_origin[axis]) < double{kMaxCoordinate},
               offsetof(FileHeader, origin), "an origin out of range", "finite, below 1e18");
    check.that(h.bounds_min[axis] > -kMaxCoordinate && h.bounds_min[axis] <= h.bounds_max[axis] &&
                   h.bounds_max[axis] < kMaxCoordinate,
               offsetof(FileHeader, bounds_min), "bounds out of range",
               "finite, ordered, below 1e18");
  }
  check.that(h.position_error >= 0 && h.position_error < double{kMaxCoordinate},
             offsetof(FileHeader, position_error), "a position error out of range",
             "finite, not negative");
}

SceneFileInfo to_info(const FileHeader& h) {
  SceneFileInfo info{};
  info.quality = static_cast<Quality>(h.quality);
  info.sh_degree = static_cast<int>(h.sh_degree);
  info.antialiased = (h.flags & kFlagAntialiased) != 0;
  info.node_count = h.node_count;
  info.leaf_count = h.leaf_count;
  info.chunk_count = h.chunk_count;
  info.depth = h.depth;
  info.origin = {h.origin[0], h.origin[1], h.origin[2]};
  info.source_origin = {h.source_origin[0], h.source_origin[1], h.source_origin[2]};
  info.bounds_min = {h.bounds_min[0], h.bounds_min[1], h.bounds_min[2]};
  info.bounds_max = {h.bounds_max[0], h.bounds_max[1], h.bounds_max[2]};
  info.position_error = h.position_error;
  info.import.read = h.import_read;
  info.import.dropped_position = h.dropped_position;
  info.import.dropped_scale = h.dropped_scale;
  info.import.repaired_scale = h.repaired_scale;
  info.import.repaired_rotation = h.repaired_rotation;
  info.import.repaired_opacity = h.repaired_opacity;
  info.import.dropped_opacity = h.dropped_opacity;
  info.import.repaired_sh = h.repaired_sh;
  return info;
}

std::vector<ChunkEntry> read_directory(const ByteSource& source, const FileHeader& h,
                                       const Check& check) {
  const uint64_t at = offsetof(FileHeader, section_count);
  const Section& section = h.directory;
  check.equal(at, "section count", h.section_count, 1);
  check.equal(at, "section kind", section.kind,
              static_cast<uint32_t>(SectionKind::chunk_directory));
  check.equal(at, "reserved field", section.reserved, 0);
  check.equal(at, "directory offset", section.offset, sizeof(FileHeader));
  check.equal(at, "directory length", section.length,
              chunks_start(h.chunk_count) - sizeof(FileHeader));
  check.at_most(at, "directory length", section.length, source.size() - sizeof(FileHeader));
  std::vector<std::byte> bytes(section.length);
  source.read(section.offset, bytes);
  check.equal(section.offset, "directory checksum", checksum(bytes), section.checksum);
  std::vector<ChunkEntry> entries(h.chunk_count);
  if (!entries.empty())
    std::memcpy(entries.data(), bytes.data(), entries.size() * sizeof(ChunkEntry));
  return entries;
}

uint64_t lossless_chunk_bytes(uint32_t nodes, uint32_t sh_degree) {
  const auto coefficients = static_cast<size_t>(sh_coefficients(static_cast<int>(sh_degree)));
  return align_to_chunk(sizeof(ChunkHeader) + lossless_payload_bytes(nodes, coefficients));
}

// Chunks follow one another without a gap, and so do their nodes: no byte of
// the file is outside a checksum, and no node outside a chunk.
void check_directory(const std::vector<ChunkEntry>& entries, const FileHeader& h,
                     const Check& check) {
  uint64_t offset = chunks_start(h.chunk_count), node = 0, child = h.node_count == 0 ? 0 : 1;
  for (size_t i = 0; i < entries.size(); ++i) {
    const ChunkEntry& e = entries[i];
    const uint64_t at = sizeof(FileHeader) + i * sizeof(ChunkEntry);
    check.equal(at, "chunk offset", e.offset, offset);
    check.at_most(at, "chunk length", e.bytes, h.file_length - offset);
    check.that(e.bytes != 0 && e.bytes % kChunkAlign == 0, at,
               "a chunk length that is no multiple of 4096", "one");
    check.equal(at, "first node", e.first_node, node);
    check.that(e.node_count != 0, at, "a chunk without nodes", "at least 1");
    check.at_most(at, "nodes in a chunk", e.node_count, kChunkNodes);
    if (h.quality == static_cast<uint32_t>(Quality::lossless))
      check.equal(at, "chunk length", e.bytes, lossless_chunk_bytes(e.node_count, h.sh_degree));
    check.at_most(at, "first child", e.first_child, h.node_count);
    check.that(i == 0 ? e.first_child == child : e.first_child >= child, at,
               "a first child out of order", "at least that of the chunk before");
    offset += e.bytes;
    node += e.node_count;
    child = e.first_child;
  }
  check.equal(offsetof(FileHeader, file_length), "end of the chunks", offset, h.file_length);
  check.equal(offsetof(FileHeader, node_count), "nodes in all chunks", node, h.node_count);
}

}  // namespace

bool SceneFile::is_scene_file(std::span<const std::byte> first_bytes) {
  return first_bytes.size() >= sizeof kSceneMagic &&
         std::memcmp(first_bytes.data(), kSceneMagic, sizeof kSceneMagic) == 0;
}

SceneFile::SceneFile(std::shared_ptr<const ByteSource> source) : source_(std::move(source)) {
  const Check check(*source_);
  const FileHeader header = read_header(*source_, check);
  check_counts(header, check);
  check_places(header, check);
  const std::vector<ChunkEntry> entries = read_directory(*source_, header, check);
  check_directory(entries, header, check);
  info_ = to_info(header);
  chunks_.reserve(entries.size());
  for (const ChunkEntry& e : entries)
    chunks_.push_back({e.offset, e.bytes, e.first_node, e.node_count, e.first_child, e.checksum});
}

SceneFile::~SceneFile() = default;

Chunk SceneFile::read_chunk(uint32_t index) const {
  const ChunkExtent& extent = chunks_.at(index);
  const uint32_t next =
      index + 1 < chunks_.size() ? chunks_[index + 1].first_child : info_.node_count;
  const ChunkPlace place{
      name(), index, extent.offset, extent.first_node, extent.node_count, extent.first_child, next};
  const ChunkContext context{
      info_.quality,
      info_.sh_degree,
      {info_.origin[0], info_.origin[1], info_.origin[2]},
      {info_.source_origin[0], info_.source_origin[1], info_.source_origin[2]},
      info_.leaf_count};
  std::vector<std::byte> bytes(extent.bytes);
  source_->read(extent.offset, bytes);
  return decode_chunk(bytes, extent.checksum, place, context);
}

}  // namespace voyager
