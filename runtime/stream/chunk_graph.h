#pragma once
// Which chunks lead to which: a chunk's nodes hang from those of its parents. Found from
// the directory alone, since nodes are numbered breadth-first, so that children are consecutive
// chunks, and parents but for those that lead nowhere.
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/format/chunk_directory.h"

namespace voyager {

// Chunks [first, last).
struct ChunkRange {
  uint32_t first, last;
  bool empty() const { return first == last; }
};

class ChunkGraph {
 public:
  // A directory as SceneFile checks it, which outlives the graph, as what tiers refers to.
  // O(n log n).
  ChunkGraph(const ChunkDirectory& chunks, const Tiers& tiers);

  uint32_t size() const { return static_cast<uint32_t>(chunks_->size()); }
  // Ascending, each before the chunk; none where it holds the tree's root and all that it leads
  // to hangs from itself. Between them may be chunks that lead nowhere: on a level with few nodes
  // a chunk hangs from places far apart, and what is between is none of its business.
  std::span<const uint32_t> parents(uint32_t chunk) const {
    return std::span(parents_).subspan(parents_begin_[chunk],
                                       parents_begin_[chunk + 1] - parents_begin_[chunk]);
  }
  // Each behind the chunk: those that it is a parent of, and no other.
  ChunkRange children(uint32_t chunk) const { return children_[chunk]; }
  // The chunks whose subtrees have these nodes as their roots: [first, first + count) on a level
  // of roots, but for the tree's. Of no nodes: the one that has roots on either side of first.
  ChunkRange with_roots(uint32_t first, uint32_t count) const {
    return with_roots(first, count, {0, size()});
  }
  // The same of the children of a node that `chunk` owns. Costs by how many chunks it leads to.
  ChunkRange with_family(uint32_t chunk, uint32_t first, uint32_t count) const;
  // The chunk that owns the parent of a root, which is not the tree's.
  uint32_t owner_of_parent(uint32_t root) const;

 private:
  ChunkRange with_roots(uint32_t first, uint32_t count, ChunkRange among) const;
  ChunkRange find_children(uint32_t chunk, uint32_t near) const;
  ChunkRange among_parents(uint32_t chunk, ChunkRange near) const;
  uint32_t owner_near(uint32_t root, uint32_t near) const;
  bool leads_beyond(uint32_t chunk, uint32_t root) const;
  uint32_t first_root(uint32_t chunk) const;
  uint32_t last_root(uint32_t chunk) const;
  SubtreePlace place_after(uint32_t chunk) const;
  uint32_t tier_of(uint32_t subtree) const;

  const ChunkDirectory* chunks_;
  Tiers tiers_;
  std::vector<uint32_t> parents_, parents_begin_;  // of all chunks, and where each one's begin
  std::vector<ChunkRange> children_;
};

}  // namespace voyager
