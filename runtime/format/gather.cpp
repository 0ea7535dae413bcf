#include "runtime/format/gather.h"

namespace voyager {
namespace {

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
  chunk.node_code.push_back(baked.node_code[node]);
  chunk.source_index.push_back(leaf ? index : kNoNode);
}

}  // namespace

Chunk gather_chunk(const BakedScene& baked, std::span<const Subtree> subtrees,
                   uint32_t first_subtree) {
  Chunk chunk;
  chunk.first_subtree = first_subtree;
  chunk.linear_leaves = baked.kept;
  chunk.subtrees.assign(subtrees.begin(), subtrees.end());
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

}  // namespace voyager
