#include "runtime/stream/search_chunks.h"

#include <cfloat>

namespace voyager {

// As make_search_tree() has it: over what the subtrees' roots hang from. A file's hull, rounded, is
// as good but where a chunk goes on with a root of the one before, and of the tree's root: those
// are never passed over.
void set_search_chunks(const SceneFile& file, uint32_t first, std::span<SearchChunk> out) {
  const ChunkDirectory& chunks = file.chunks();
  const uint32_t top = file.tiers().tier_begin[1];
  for (SearchChunk& chunk : out) {
    const uint32_t index = first++;
    if (index == chunks.size()) {
      chunk = {{0, 0, 0}, 0, {0, 0, 0}, file.info().subtree_count};
      continue;
    }
    const uint32_t subtree = chunks.first_subtree(index);
    if (subtree < top || chunks.place(index).listed_children != 0) {
      chunk = {{-FLT_MAX, -FLT_MAX, -FLT_MAX}, FLT_MAX, {FLT_MAX, FLT_MAX, FLT_MAX}, subtree};
      continue;
    }
    const EntryHull hull = chunks.hull(index);
    chunk = {hull.box_min, hull.extent, hull.box_max, subtree};
  }
}

}  // namespace voyager
