#pragma once
// How much room a pool has beside its slots. Search records come in blocks, of which a chunk takes
// as many as its interior nodes need. How many that are is known once the chunk was read; before
// that the directory tells a bound. Subtrees come in pages, and how many a chunk touches is known.
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
  // room for all that is pinned and for one more. Pages are enough for any so many chunks, and one
  // in eight to spare for what has gone, whose page is kept for a while. Grows with the slots.
  PoolRoom of(uint32_t slots) const;
  // The least of these that has room for so many chunks with so many blocks, beside what is pinned.
  PoolRoom enough(uint64_t chunks, uint64_t blocks) const;

 private:
  uint32_t most_blocks(const ChunkEntry& chunk, const SubtreePlace& after) const;
  uint32_t chunks() const { return static_cast<uint32_t>(file_.chunks().size()); }
  uint32_t most_pages(uint32_t slots) const;

  const SceneFile& file_;
  const Tiers tiers_;
  uint32_t greatest_ = 0;           // of most_blocks()
  uint32_t all_ = 0;                // that all chunks together take at most
  uint64_t sum_of_most_ = 0;        // which is more
  std::vector<uint32_t> touching_;  // chunks that touch so many pages, by how many
  uint32_t all_pages_ = 0;
};

// The records of a chunk's interior nodes are no more than this: each leads to another node, of
// its own subtree's next level or below its tier. after: the place of the next chunk.
uint32_t most_search_records(const ChunkEntry& chunk, const SubtreePlace& after,
                             const Tiers& tiers);

}  // namespace voyager
