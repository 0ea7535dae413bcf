#include "runtime/stream/search_chunks.h"

namespace voyager {

// As make_search_tree() has it: over what the subtrees' roots hang from. A file's hull, rounded, is
// as good but where a chunk goes on with a root of the one before, and of the tree's root: those
// are never passed over.
SearchChunk search_chunk(const SceneFile& file, uint32_t chunk) {
  const ChunkDirectory& chunks = file.chunks();
  const uint32_t first = chunks.first_subtree(chunk);
  const uint32_t last =
      chunk + 1 < chunks.size() ? chunks.first_subtree(chunk + 1) : file.info().subtree_count;
  const bool always = first < file.tiers().tier_begin[1] || chunks.goes_on_with_root(chunk);
  return {always ? encode_bounds(kAlwaysReached) : chunks.hull_code(chunk), first, last};
}

}  // namespace voyager
