#include "runtime/format/writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "runtime/base/checksum.h"
#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "runtime/format/chunk_codec.h"
#include "runtime/format/planes.h"

namespace voyager {
namespace {

// Chunks encoded at a time: enough for every thread, little in memory.
constexpr size_t kBatch = 256;

template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  return std::as_bytes(std::span(&value, 1));
}

Vec3d to_vec(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
}

void add_gaussian(const BakedScene& baked, uint32_t node, size_t floats, Chunk& chunk) {
  const bool leaf = baked.tree.is_leaf(node);
  const GaussianCloud& cloud = leaf ? baked.leaves : baked.merged;
  const uint32_t index = baked.gaussian[node];
  const GaussianWords words = cloud.words(index);
  chunk.position_words.insert(chunk.position_words.end(),
                              {words.mean.x, words.mean.y, words.mean.z});
  chunk.words.push_back(leaf ? leaf_words(baked, index) : words);
  const float* sh = cloud.sh.data() + index * floats;
  chunk.sh.insert(chunk.sh.end(), sh, sh + floats);
  chunk.axis_code.push_back(baked.axis_code[node]);
  chunk.source_index.push_back(leaf ? index : kNoNode);
}

// A chunk as the codec takes it.
Chunk gather(const BakedScene& baked, const Partition& partition, size_t index) {
  Chunk chunk;
  chunk.first_subtree = partition.chunk_begin[index];
  chunk.subtrees.assign(partition.subtrees.begin() + partition.chunk_begin[index],
                        partition.subtrees.begin() + partition.chunk_begin[index + 1]);
  const size_t floats = static_cast<size_t>(baked.leaves.coefficients()) * 3;
  for (const Subtree& subtree : chunk.subtrees)
    for (uint32_t slot = 0; slot < subtree.node_count(); ++slot) {
      const uint32_t node = subtree.node(slot);
      const auto record = static_cast<uint32_t>(chunk.records.size());
      chunk.records.push_back(baked.tree.records[node]);
      if (subtree.repeats(slot)) continue;
      chunk.record.push_back(record);
      add_gaussian(baked, node, floats, chunk);
    }
  return chunk;
}

// Where each chunk starts, and what it counts.
std::vector<ChunkEntry> make_entries(const LodTree& tree, const Partition& partition) {
  std::vector<ChunkEntry> entries(partition.chunk_count());
  SubtreeCursor cursor(tiers_of(partition));
  for (size_t chunk = 0; chunk < entries.size(); ++chunk) {
    ChunkEntry& entry = entries[chunk];
    entry.first_subtree = partition.chunk_begin[chunk];
    entry.subtree_count = partition.chunk_begin[chunk + 1] - entry.first_subtree;
    entry.place = cursor.place();
    entry.hull = partition.chunk_hull[chunk];
    for (uint32_t i = 0; i < entry.subtree_count; ++i) {
      Subtree subtree = partition.subtrees[entry.first_subtree + i];
      NodeRecord records[kSubtreeNodes];
      for (uint32_t slot = 0; slot < subtree.node_count(); ++slot)
        records[slot] = tree.records[subtree.node(slot)];
      const bool repeats[] = {subtree.repeats_root, subtree.repeats_child};
      entry.record_count += subtree.node_count();
      entry.node_count += subtree.node_count() - repeats[0] - repeats[1];
      cursor.take(subtree.child_count, subtree.grandchild_count, records, subtree);
    }
  }
  return entries;
}

bool leaves_have_extent(const LodTree& tree) {
  return std::any_of(tree.records.begin(), tree.records.end(),
                     [](const NodeRecord& r) { return r.child_count == 0 && r.extent != 0; });
}

FileHeader make_header(const BakedScene& baked, const Partition& partition, Quality quality) {
  FileHeader h{};
  std::memcpy(h.magic, kSceneMagic, sizeof h.magic);
  h.version = kSceneVersion;
  h.flags = (baked.leaves.antialiased ? kFlagAntialiased : 0) |
            (leaves_have_extent(baked.tree) ? kFlagLeafExtents : 0);
  h.quality = static_cast<uint32_t>(quality);
  h.sh_degree = static_cast<uint32_t>(baked.leaves.sh_degree);
  h.node_count = static_cast<uint32_t>(baked.tree.size());
  h.leaf_count = static_cast<uint32_t>(baked.leaves.size());
  h.chunk_count = static_cast<uint32_t>(partition.chunk_count());
  h.depth = baked.tree.size() == 0 ? 0 : static_cast<uint32_t>(partition.level_begin.size() - 1);
  h.subtree_count = static_cast<uint32_t>(partition.subtrees.size());
  h.chunk_bytes = partition.chunk_bytes;
  h.first_tier_levels = partition.first_tier_levels;
  for (size_t axis = 0; axis < 3; ++axis) {
    h.origin[axis] = baked.origin[axis];
    h.source_origin[axis] = baked.leaves.origin[axis];
    if (baked.tree.size() == 0) continue;
    h.bounds_min[axis] = baked.tree.records[0].box_min[static_cast<int>(axis)];
    h.bounds_max[axis] = baked.tree.records[0].box_max[static_cast<int>(axis)];
  }
  const ImportReport& report = baked.leaves.report;
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

// The levels and the tiers, then the directory, which is padded to the first chunk.
std::vector<std::byte> make_sections(const Partition& partition,
                                     const std::vector<ChunkEntry>& entries, FileHeader& header) {
  std::vector<std::byte> bytes;
  PlaneWriter planes(bytes);
  planes.put(partition.level_begin.data(), partition.level_begin.size());
  planes.put(partition.tier_begin.data(), partition.tier_begin.size());
  bytes.resize(align_up(bytes.size(), sizeof(uint64_t)));
  const size_t tiers = bytes.size();
  planes.put(entries.data(), entries.size());
  const uint64_t start = sizeof(FileHeader);
  bytes.resize(align_up(start + bytes.size(), chunk_align(Quality{header.quality})) - start);
  const std::span<const std::byte> all(bytes);
  const auto section = [&](SectionKind kind, size_t begin, size_t end) {
    return Section{static_cast<uint32_t>(kind), 0, start + begin, end - begin,
                   checksum(all.subspan(begin, end - begin))};
  };
  header.section_count = 2;
  header.tiers = section(SectionKind::tiers, 0, tiers);
  header.directory = section(SectionKind::chunk_directory, tiers, bytes.size());
  return bytes;
}

void finish_file(AtomicFile& file, const Partition& partition,
                 const std::vector<ChunkEntry>& entries, FileHeader& header) {
  const std::vector<std::byte> sections = make_sections(partition, entries, header);
  header.file_length = file.position();
  header.checksum = checksum(bytes_of(header).first(offsetof(FileHeader, checksum)));
  file.write_at(0, bytes_of(header));
  file.write_at(sizeof(FileHeader), sections);
  file.commit();
}

}  // namespace

void write_scene_file(const BakedScene& baked, const Partition& partition, const std::string& path,
                      Quality quality, Workers& workers, const Progress& progress) {
  if (baked.tree.size() >= kNoNode)
    throw Error(ErrorCode::unsupported, path + ": found " + std::to_string(baked.tree.size()) +
                                            " nodes, expected fewer than 2^32 - 1");
  const ChunkContext context{quality,
                             baked.leaves.sh_degree,
                             to_vec(baked.origin),
                             to_vec(baked.leaves.origin),
                             static_cast<uint32_t>(baked.leaves.size()),
                             tiers_of(partition),
                             0,
                             false};
  std::vector<ChunkEntry> entries = make_entries(baked.tree, partition);
  const size_t chunks = entries.size();
  FileHeader header = make_header(baked, partition, quality);
  AtomicFile file(path);
  file.write(
      std::vector<std::byte>(sizeof header + make_sections(partition, entries, header).size()));
  for (size_t begin = 0; begin < chunks; begin += kBatch) {
    report(progress, "writing", begin, chunks);
    std::vector<EncodedChunk> batch(std::min(kBatch, chunks - begin));
    workers.for_blocks(batch.size(), 8, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i)
        batch[i] = encode_chunk(gather(baked, partition, begin + i), context);
    });
    for (size_t i = 0; i < batch.size(); ++i) {
      ChunkEntry& entry = entries[begin + i];
      entry.offset = file.position();
      entry.bytes = static_cast<uint32_t>(batch[i].bytes.size());
      entry.checksum = batch[i].checksum;
      file.write(batch[i].bytes);
      header.position_error = std::max(header.position_error, batch[i].position_error);
      header.largest_sh = std::max(header.largest_sh, batch[i].largest_sh);
    }
  }
  finish_file(file, partition, entries, header);
  report(progress, "writing", chunks, chunks);
}

}  // namespace voyager
