#pragma once
// How much room a pool has beside its slots. Search records come in blocks, of which a chunk takes
// as many as its interior nodes need. How many that are is known once the chunk was read; before
// that the directory tells a bound. Subtrees come in pages, and how many a chunk touches is known.
// Of large families, which few trees have, the directory tells a bound, too.
#include <vector>

#include "runtime/format/reader.h"
#include "runtime/stream/chunk_pool.h"

namespace voyager {

class RecordRoom {
 public:
  // The file outlives it.
  explicit RecordRoom(const SceneFile& file);

  // That the chunk takes at most.
  uint32_t most_blocks(uint32_t chunk) const;
  uint32_t most_blocks() const { return greatest_; }
  // What chunks probably take of which this is the most.
  uint64_t likely_blocks(uint64_t most) const;
  // What goes with so many slots. Chunks of upper levels take more records, and are needed first:
  // for a share f of all chunks there is (3 - f) / 2 times what so many take in the mean. There is
  // room for all that is pinned and for one more. Pages and families are enough for any so many
  // chunks, with one page in eight to spare for what has gone, whose page is kept for a while.
  // Grows with the slots.
  PoolRoom of(uint32_t slots) const;
  // The least of these that has room for so many chunks with so many blocks, beside what is pinned.
  PoolRoom enough(uint64_t chunks, uint64_t blocks) const;

 private:
  // How many chunks have so many of something.
  class Tally {
   public:
    void add(uint32_t count);
    // What so many chunks have at most, if they are those that have the most.
    uint64_t most(uint32_t chunks) const;

   private:
    std::vector<uint32_t> chunks_;  // by count
  };

  uint32_t most_blocks(const ChunkEntry& chunk, const SubtreePlace& after) const;
  uint32_t chunks() const { return static_cast<uint32_t>(file_.chunks().size()); }

  const SceneFile& file_;
  const Tiers tiers_;
  uint32_t greatest_ = 0;     // of most_blocks()
  uint32_t all_ = 0;          // that all chunks together take at most
  uint64_t sum_of_most_ = 0;  // which is more
  Tally pages_, families_;    // pages as if none shared one
  uint32_t all_pages_ = 0;
};

// The records of a chunk's interior nodes are no more than this: each leads to another node, of
// its own subtree's next level or below its tier. after: the place of the next chunk.
uint32_t most_search_records(const ChunkEntry& chunk, const SubtreePlace& after,
                             const Tiers& tiers);
// How many of a chunk's nodes have large families, at most.
uint32_t most_large_families(const ChunkEntry& chunk, const SubtreePlace& after,
                             const Tiers& tiers);

}  // namespace voyager
