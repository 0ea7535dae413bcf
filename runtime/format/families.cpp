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
  for (const Subtree& subtree : chunk.subtrees) counts.of_subtree.push_back(counts_of(subtree));
  for (const NodeRecord& r : chunk.records) counts.of_record.push_back(r.child_count);
  return counts;
}

Families families_of(const ChunkCounts& counts) {
  const auto records = static_cast<uint32_t>(counts.of_record.size());
  Families families{std::vector<Families::Run>(records, {0, 0}),
                    std::vector<uint32_t>(records, kNoNode)};
  uint32_t first = 0;  // of the subtree
  for (const SubtreeCounts& of : counts.of_subtree) {
    const Subtree subtree{0, 0, 0, of.roots, of.children, of.grandchildren, Repeats::nothing};
    if (subtree.node_count() > records - first) break;
    each_family(
        subtree, [&](uint32_t slot) { return counts.of_record[first + slot]; },
        [&](uint32_t parent, uint32_t child, uint32_t count) {
          link(first + parent, first + child, count, counts, families);
        });
    first += subtree.node_count();
  }
  return families;
}

}  // namespace voyager
