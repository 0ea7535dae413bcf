#include "runtime/format/writer.h"

#include <algorithm>

#include "runtime/base/error.h"
#include "runtime/base/file.h"
#include "runtime/format/chunk_codec.h"
#include "runtime/format/further.h"
#include "runtime/format/gather.h"
#include "runtime/format/scene_header.h"

namespace voyager {
namespace {

// Chunks encoded at a time: enough for every thread, little in memory.
constexpr size_t kBatch = 256;

Vec3d to_vec(const std::array<double, 3>& v) {
  return {v[0], v[1], v[2]};
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
      entry.record_count += subtree.node_count();
      entry.node_count += subtree.node_count() - subtree.first_owned_slot();
      cursor.take(counts_of(subtree), records, subtree);
    }
  }
  return entries;
}

SceneTotals totals_of(const BakedScene& baked, const Partition& partition, Quality quality) {
  SceneTotals totals;
  totals.quality = quality;
  totals.sh_degree = baked.leaves.sh_degree;
  totals.left_out_bands = baked.leaves.left_out_bands;
  totals.native = baked.leaves.native;
  totals.leaf_count = static_cast<uint32_t>(baked.leaves.size());
  totals.chunk_bytes = partition.chunk_bytes;
  totals.tiers = tiers_of(partition);
  totals.origin = baked.origin;
  totals.source_origin = baked.leaves.origin;
  if (baked.tree.size() != 0) {
    totals.bounds_min = baked.tree.records[0].box_min;
    totals.bounds_max = baked.tree.records[0].box_max;
  }
  totals.import = baked.leaves.report;
  totals.tree = baked.kind;
  totals.blend_share = baked.tree.blend_share;
  totals.kept_tree = baked.kept;
  totals.further = !baked.further.nodes.empty();
  return totals;
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
                             extent_rule(baked.kind, baked.tree.blend_share)};
  std::vector<ChunkEntry> entries = make_entries(baked.tree, partition);
  const size_t chunks = entries.size();
  SceneTotals totals = totals_of(baked, partition, quality);
  AtomicFile file(path);
  file.write(std::vector<std::byte>(bytes_before_chunks(totals.tiers, chunks, quality)));
  for (size_t begin = 0; begin < chunks; begin += kBatch) {
    report(progress, "writing", begin, chunks);
    std::vector<EncodedChunk> batch(std::min(kBatch, chunks - begin));
    workers.for_blocks(batch.size(), 8, [&](size_t first, size_t last) {
      for (size_t i = first; i < last; ++i) {
        const ChunkEntry& entry = entries[begin + i];
        const auto subtrees =
            std::span(partition.subtrees).subspan(entry.first_subtree, entry.subtree_count);
        batch[i] = encode_chunk(gather_chunk(baked, subtrees, entry.first_subtree), context);
      }
    });
    for (size_t i = 0; i < batch.size(); ++i) {
      ChunkEntry& entry = entries[begin + i];
      entry.offset = file.position();
      entry.bytes = static_cast<uint32_t>(batch[i].bytes.size());
      entry.checksum = batch[i].checksum;
      file.write(batch[i].bytes);
      totals.position_error = std::max(totals.position_error, batch[i].position_error);
      totals.largest_sh = std::max(totals.largest_sh, batch[i].largest_sh);
      totals.leaves_have_extent |= batch[i].leaves_have_extent;
    }
  }
  if (totals.further) write_further(file, baked.further);
  file.write_at(0, encode_head(totals, entries, file.position()));
  file.commit();
  report(progress, "writing", chunks, chunks);
}

}  // namespace voyager
