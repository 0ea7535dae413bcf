#include "runtime/format/families.h"

#include <algorithm>

namespace voyager {
namespace {

void link(uint32_t parent, uint32_t first, uint32_t count, const ChunkCounts& counts,
          Families& families) {
  std::fill_n(families.parent.begin() + first, count, parent);
  if (count == counts.of_record[parent]) families.children[parent] = {first, count};
}

}  // namespace

ChunkCounts counts_of(const Chunk& chunk) {
  ChunkCounts counts;
  for (const Subtree& subtree : chunk.subtrees) {
    counts.children.push_back(subtree.child_count);
    counts.grandchildren.push_back(subtree.grandchild_count);
  }
  for (const NodeRecord& r : chunk.records) counts.of_record.push_back(r.child_count);
  return counts;
}

Families families_of(const ChunkCounts& counts) {
  const auto records = static_cast<uint32_t>(counts.of_record.size());
  Families families{std::vector<Families::Run>(records, {0, 0}),
                    std::vector<uint32_t>(records, kNoNode)};
  uint32_t root = 0;
  for (size_t i = 0; i < counts.children.size(); ++i) {
    const uint32_t children = counts.children[i], grandchildren = counts.grandchildren[i];
    if (1 + children + grandchildren > records - root) break;
    uint32_t next = root + 1 + children;
    const uint32_t end = next + grandchildren;
    link(root, root + 1, children, counts, families);
    for (uint32_t child = root + 1; child <= root + children; ++child) {
      const uint32_t listed = std::min(counts.of_record[child], end - next);
      link(child, next, listed, counts, families);
      next += listed;
    }
    root = end;
  }
  return families;
}

}  // namespace voyager
