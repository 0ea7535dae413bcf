#pragma once
// Which chunks lead to which: a chunk's nodes hang from those of its parents. Found from
// the directory alone, since nodes are numbered breadth-first, so that parents and children
// are consecutive chunks.
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/format/layout.h"

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
  ChunkGraph(std::span<const ChunkEntry> chunks, const Tiers& tiers);

  uint32_t size() const { return static_cast<uint32_t>(chunks_.size()); }
  // Each before the chunk; none where it holds the tree's root and all that it leads to
  // hangs from itself. One between two that lead to the chunk is a parent even where nothing
  // hangs from it: they are a range.
  ChunkRange parents(uint32_t chunk) const { return parents_[chunk]; }
  // Each behind the chunk: those that it is a parent of, and no other.
  ChunkRange children(uint32_t chunk) const { return children_[chunk]; }
  // The chunks whose subtrees have these nodes as their roots: [first, first + count) on a level
  // of roots, but for the tree's. Of no nodes: the one that has roots on either side of first.
  ChunkRange with_roots(uint32_t first, uint32_t count) const;
  // The chunk that owns the parent of a root, which is not the tree's.
  uint32_t owner_of_parent(uint32_t root) const;

 private:
  uint32_t first_root(uint32_t chunk) const;
  uint32_t last_root(uint32_t chunk) const;
  SubtreePlace place_after(uint32_t chunk) const;
  uint32_t tier_of(uint32_t subtree) const;

  std::span<const ChunkEntry> chunks_;
  Tiers tiers_;
  std::vector<ChunkRange> parents_, children_;
};

}  // namespace voyager
