#include "runtime/format/lossless_codec.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "runtime/format/check_chunk.h"
#include "runtime/format/planes.h"

namespace voyager {
namespace {

// The same operations as local_mean() in runtime/lod/baked_scene.h, which has a
// cloud where a chunk has only words.
Vec3f scene_local(const Vec3f& word, const ChunkContext& context) {
  Vec3f mean{};
  for (int axis = 0; axis < 3; ++axis)
    mean[axis] = static_cast<float>((double{word[axis]} + context.source_origin[axis]) -
                                    context.origin[axis]);
  return mean;
}

// Turns the words that a chunk was read with into means, and keeps the words
// where a bit of them differs.
void place_leaves(const ChunkContext& context, Chunk& chunk) {
  std::vector<float> words;
  words.reserve(chunk.words.size() * 3);
  bool differ = false;
  for (size_t i = 0; i < chunk.words.size(); ++i) {
    Vec3f& mean = chunk.words[i].mean;
    const Vec3f word = mean;
    words.insert(words.end(), {word.x, word.y, word.z});
    if (chunk.is_leaf(i)) mean = scene_local(word, context);
    for (int axis = 0; axis < 3; ++axis)
      differ |= std::bit_cast<uint32_t>(mean[axis]) != std::bit_cast<uint32_t>(word[axis]);
  }
  if (differ) chunk.position_words = std::move(words);
}

// The counts of subtrees, and zeros up to where words can be mapped.
size_t table_bytes(size_t subtrees, uint32_t version) {
  return align_up(subtree_count_bytes(version) * subtrees, sizeof(float));
}

void put_table(const Chunk& chunk, uint32_t version, PlaneWriter& planes) {
  std::vector<uint8_t> table;
  table.reserve(table_bytes(chunk.subtrees.size(), version));
  if (has_root_counts(version))
    for (const Subtree& subtree : chunk.subtrees) table.push_back(subtree.root_count);
  for (const Subtree& subtree : chunk.subtrees) table.push_back(subtree.child_count);
  for (const Subtree& subtree : chunk.subtrees) table.push_back(subtree.grandchild_count);
  table.resize(table_bytes(chunk.subtrees.size(), version));
  planes.put(table.data(), table.size());
}

void take_table(PlaneReader& planes, const ChunkLocation& location, const ChunkContext& context,
                Chunk& chunk) {
  const size_t count = location.entry.subtree_count;
  std::vector<uint8_t> table(table_bytes(count, context.version));
  planes.take(table.data(), table.size());
  for (size_t i = subtree_count_bytes(context.version) * count; i < table.size(); ++i)
    if (table[i] != 0) location.damaged("a subtree table with more than its counts", "zeros");
  const bool roots = has_root_counts(context.version);
  const uint8_t *const children = table.data() + (roots ? count : 0), *const grandchildren =
                                                                          children + count;
  std::vector<SubtreeCounts> counts(count);
  for (size_t i = 0; i < count; ++i)
    counts[i] = {roots ? table[i] : uint8_t{1}, children[i], grandchildren[i]};
  link_subtrees(counts, location, context, chunk);
}

}  // namespace

uint64_t lossless_payload_bytes(const ChunkEntry& entry, size_t coefficients, uint32_t version) {
  const size_t node =
      sizeof(GaussianWords) + coefficients * 3 * sizeof(float) + sizeof(uint32_t) + sizeof(uint8_t);
  return entry.record_count * sizeof(NodeRecord) + table_bytes(entry.subtree_count, version) +
         entry.node_count * node;
}

void encode_lossless(const Chunk& chunk, const ChunkContext& context, EncodedChunk& out) {
  PlaneWriter planes(out.bytes);
  planes.put(chunk.records.data(), chunk.records.size());
  put_table(chunk, context.version, planes);
  if (chunk.position_words.empty())
    for (const GaussianWords& w : chunk.words) planes.put(&w.mean, 1);
  else
    planes.put(chunk.position_words.data(), chunk.position_words.size());
  for (const GaussianWords& w : chunk.words) planes.put(&w.log_scale, 1);
  for (const GaussianWords& w : chunk.words) planes.put(&w.rotation, 1);
  for (const GaussianWords& w : chunk.words) planes.put(&w.opacity, 1);
  planes.put(chunk.sh.data(), chunk.sh.size());
  planes.put(chunk.source_index.data(), chunk.source_index.size());
  planes.put(chunk.node_code.data(), chunk.node_code.size());
  for (const float sh : chunk.sh) out.largest_sh = std::max(out.largest_sh, std::fabs(sh));
}

void decode_lossless(std::span<const std::byte> payload, const ChunkLocation& location,
                     const ChunkContext& context, Chunk& chunk) {
  const size_t nodes = location.entry.node_count;
  PlaneReader planes(payload);
  chunk.records.resize(location.entry.record_count);
  planes.take(chunk.records.data(), chunk.records.size());
  take_table(planes, location, context, chunk);
  chunk.words.resize(nodes);
  for (GaussianWords& w : chunk.words) planes.take(&w.mean, 1);
  for (GaussianWords& w : chunk.words) planes.take(&w.log_scale, 1);
  for (GaussianWords& w : chunk.words) planes.take(&w.rotation, 1);
  for (GaussianWords& w : chunk.words) planes.take(&w.opacity, 1);
  chunk.sh.resize(nodes * context.coefficients() * 3);
  planes.take(chunk.sh.data(), chunk.sh.size());
  chunk.source_index.resize(nodes);
  planes.take(chunk.source_index.data(), nodes);
  chunk.node_code.resize(nodes);
  planes.take(chunk.node_code.data(), nodes);
  place_leaves(context, chunk);
}

}  // namespace voyager
