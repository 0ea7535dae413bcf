#include "runtime/format/reader.h"

#include "runtime/format/check_claims.h"
#include "runtime/format/chunk_codec.h"
#include "runtime/format/read_header.h"
#include "runtime/format/read_sections.h"

namespace voyager {
namespace {

SceneFileInfo to_info(const FileHeader& h) {
  SceneFileInfo info{};
  info.quality = static_cast<Quality>(h.quality);
  info.sh_degree = static_cast<int>(h.sh_degree);
  info.left_out_bands = static_cast<int>(h.left_out_bands);
  if (h.version == 4 && (h.flags & kFlagAntialiased) != 0)
    info.native = compensated_scale(kLowPass);
  else
    info.native = {static_cast<NativeSource>(h.native_source), h.native_pixel, h.low_pass,
                   1 + static_cast<int>((h.flags & kFootprintMask) >> kFootprintShift)};
  info.tree = (h.flags & kFlagClustered) != 0 ? TreeKind::clustered : TreeKind::hierarchicalgs;
  info.blend_share = h.blend_share;
  info.kept_tree = (h.flags & kFlagKeptTree) != 0;
  info.node_count = h.node_count;
  info.leaf_count = h.leaf_count;
  info.chunk_count = h.chunk_count;
  info.depth = h.depth;
  info.subtree_count = h.subtree_count;
  info.chunk_bytes = h.chunk_bytes;
  info.first_tier_levels = h.first_tier_levels;
  info.origin = {h.origin[0], h.origin[1], h.origin[2]};
  info.source_origin = {h.source_origin[0], h.source_origin[1], h.source_origin[2]};
  info.bounds_min = {h.bounds_min[0], h.bounds_min[1], h.bounds_min[2]};
  info.bounds_max = {h.bounds_max[0], h.bounds_max[1], h.bounds_max[2]};
  info.position_error = h.position_error;
  info.largest_sh = h.largest_sh;
  info.leaves_have_extent = (h.flags & kFlagLeafExtents) != 0;
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

}  // namespace

bool SceneFile::is_scene_file(std::span<const std::byte> first_bytes) {
  return has_scene_magic(first_bytes);
}

SceneFile::SceneFile(std::shared_ptr<const ByteSource> source) : source_(std::move(source)) {
  const Check check(*source_);
  const FileHeader header = read_header(*source_, check);
  FileSections sections = read_sections(*source_, header, check);
  info_ = to_info(header);
  version_ = header.version;
  level_begin_ = std::move(sections.level_begin);
  tier_begin_ = std::move(sections.tier_begin);
  chunks_ = std::move(sections.chunks);
  if ((header.flags & kFlagFurther) != 0)
    info_.further_offset = chunks_.back().offset + chunks_.back().bytes;
  check_claims(*this, process_seed());
}

SceneFile::~SceneFile() = default;

Tiers SceneFile::tiers() const {
  return {info_.first_tier_levels, level_begin_, tier_begin_};
}

SubtreePlace SceneFile::place_after(uint32_t index) const {
  return index + 1 < chunks_.size() ? chunks_.place(index + 1) : SubtreePlace::end_of(tiers());
}

std::vector<NodeRange> SceneFile::nodes_of(uint32_t index) const {
  return nodes_between(tiers(), chunks_.at(index).place, place_after(index));
}

std::vector<std::byte> SceneFile::read_stored(uint32_t first, uint32_t last) const {
  const ChunkEntry from = chunks_.at(first), to = chunks_.at(last - 1);
  std::vector<std::byte> bytes(to.offset + to.bytes - from.offset);
  source_->read(from.offset, bytes);
  return bytes;
}

Chunk SceneFile::read_chunk(uint32_t index) const {
  return decode(index, read_stored(index, index + 1));
}

Chunk SceneFile::decode(uint32_t index, std::span<const std::byte> stored) const {
  const ChunkEntry entry = chunks_.at(index);
  const ChunkContext context{
      info_.quality,
      info_.sh_degree,
      {info_.origin[0], info_.origin[1], info_.origin[2]},
      {info_.source_origin[0], info_.source_origin[1], info_.source_origin[2]},
      info_.leaf_count,
      tiers(),
      extent_rule(info_.tree, info_.blend_share),
      version_,
      info_.largest_sh,
      info_.leaves_have_extent,
      info_.native.levels,
      info_.kept_tree};
  return decode_chunk(stored, {name(), index, entry, place_after(index)}, context);
}

}  // namespace voyager
