#include "runtime/format/scene_header.h"

#include <cstring>

#include "runtime/base/checksum.h"
#include "runtime/format/planes.h"

namespace voyager {
namespace {

uint64_t bytes_of_tiers(const Tiers& tiers) {
  return align_up((tiers.level_begin.size() + tiers.tier_begin.size()) * sizeof(uint32_t),
                  sizeof(uint64_t));
}

FileHeader make_header(const SceneTotals& totals, size_t chunks) {
  FileHeader h{};
  std::memcpy(h.magic, kSceneMagic, sizeof h.magic);
  h.version = kSceneVersion;
  h.flags = (totals.native.antialiased() ? kFlagAntialiased : 0) |
            (totals.leaves_have_extent ? kFlagLeafExtents : 0) |
            (totals.tree == TreeKind::clustered ? kFlagClustered : 0) |
            (totals.kept_tree ? kFlagKeptTree : 0) | (totals.further ? kFlagFurther : 0) |
            static_cast<uint32_t>(totals.native.levels - 1) << kFootprintShift;
  h.quality = static_cast<uint32_t>(totals.quality);
  h.sh_degree = static_cast<uint32_t>(totals.sh_degree);
  h.node_count = totals.tiers.node_count();
  h.leaf_count = totals.leaf_count;
  h.chunk_count = static_cast<uint32_t>(chunks);
  const size_t levels = totals.tiers.level_begin.size();
  h.depth = levels == 0 ? 0 : static_cast<uint32_t>(levels - 1);
  h.subtree_count = totals.tiers.tier_begin.empty() ? 0 : totals.tiers.tier_begin.back();
  h.chunk_bytes = totals.chunk_bytes;
  h.first_tier_levels = totals.tiers.first_tier_levels;
  for (size_t axis = 0; axis < 3; ++axis) {
    h.origin[axis] = totals.origin[axis];
    h.source_origin[axis] = totals.source_origin[axis];
    h.bounds_min[axis] = totals.bounds_min[static_cast<int>(axis)];
    h.bounds_max[axis] = totals.bounds_max[static_cast<int>(axis)];
  }
  h.position_error = totals.position_error;
  h.largest_sh = totals.largest_sh;
  h.left_out_bands = static_cast<uint32_t>(totals.left_out_bands);
  h.native_pixel = totals.native.pixel;
  h.low_pass = totals.native.low_pass;
  h.native_source = static_cast<uint32_t>(totals.native.source);
  h.blend_share = totals.blend_share;
  const ImportReport& report = totals.import;
  h.import_read = report.read;
  h.dropped_position = report.dropped_position;
  h.dropped_scale = report.dropped_scale;
  h.repaired_scale = report.repaired_scale;
  h.repaired_rotation = report.repaired_rotation;
  h.repaired_opacity = report.repaired_opacity;
  h.dropped_opacity = report.dropped_opacity;
  h.repaired_sh = report.repaired_sh;
  return h;
}

}  // namespace

uint64_t bytes_before_chunks(const Tiers& tiers, size_t chunks, Quality quality) {
  return align_up(sizeof(FileHeader) + bytes_of_tiers(tiers) + chunks * sizeof(ChunkEntry),
                  chunk_align(quality));
}

std::vector<std::byte> encode_head(const SceneTotals& totals,
                                   const std::vector<ChunkEntry>& entries, uint64_t file_length) {
  FileHeader header = make_header(totals, entries.size());
  std::vector<std::byte> bytes(sizeof header);
  PlaneWriter planes(bytes);
  planes.put(totals.tiers.level_begin.data(), totals.tiers.level_begin.size());
  planes.put(totals.tiers.tier_begin.data(), totals.tiers.tier_begin.size());
  const size_t directory = sizeof header + bytes_of_tiers(totals.tiers);
  bytes.resize(directory);
  planes.put(entries.data(), entries.size());
  bytes.resize(bytes_before_chunks(totals.tiers, entries.size(), totals.quality));
  const std::span<const std::byte> all(bytes);
  const auto section = [&](SectionKind kind, size_t begin, size_t end) {
    return Section{static_cast<uint32_t>(kind), 0, begin, end - begin,
                   checksum(all.subspan(begin, end - begin))};
  };
  header.section_count = 2;
  header.tiers = section(SectionKind::tiers, sizeof header, directory);
  header.directory = section(SectionKind::chunk_directory, directory, bytes.size());
  header.file_length = file_length;
  header.checksum =
      checksum(std::as_bytes(std::span(&header, 1)).first(offsetof(FileHeader, checksum)));
  std::memcpy(bytes.data(), &header, sizeof header);
  return bytes;
}

}  // namespace voyager
