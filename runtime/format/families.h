#pragma once
// Who is whose child among the records of a chunk, as far as its subtrees show it.
#include <cstdint>
#include <vector>

#include "runtime/format/chunk.h"
#include "runtime/lod/subtree_cursor.h"

namespace voyager {

struct ChunkCounts {
  std::vector<SubtreeCounts> of_subtree;
  std::vector<uint32_t> of_record;  // children
};
ChunkCounts counts_of(const Chunk& chunk);

struct Families {
  struct Run {
    uint32_t first, count;
  };
  std::vector<Run> children;     // of each record; of count 0 where not all are in its subtree
  std::vector<uint32_t> parent;  // of each record; kNoNode where it is not in its subtree
};

// Safe for any counts: what lies beyond the records is of no family. O(n).
Families families_of(const ChunkCounts& counts);

}  // namespace voyager
