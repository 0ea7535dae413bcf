#pragma once
// Which chunks lead to which: a chunk's nodes hang from those of its parents. Found from
// the directory alone, since nodes are numbered breadth-first, so that children are consecutive
// chunks, and parents but for those that lead nowhere.
#include <bit>
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
    const ChunkRange at = parents_[chunk];
    return std::span(leading_).subspan(at.first, at.last - at.first);
  }
  // Each behind the chunk: those that it is a parent of, and no other.
  ChunkRange children(uint32_t chunk) const {
    const Word& word = words_[chunk / 64];
    const uint64_t own = uint64_t{1} << chunk % 64;
    if ((word.leads & own) == 0) return {0, 0};
    return children_[word.before + static_cast<uint32_t>(std::popcount(word.leads & (own - 1)))];
  }
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
  class Builder;

  ChunkRange with_roots(uint32_t first, uint32_t count, ChunkRange among) const;
  uint32_t first_root(uint32_t chunk) const;
  uint32_t last_root(uint32_t chunk) const;
  SubtreePlace place_after(uint32_t chunk) const;
  uint32_t tier_of(uint32_t subtree) const;

  const ChunkDirectory* chunks_;
  Tiers tiers_;
  // Of 64 chunks.
  struct Word {
    uint64_t leads;   // a bit for each that leads to others
    uint32_t before;  // how many of those are in front
  };
  std::vector<Word> words_;
  std::vector<uint32_t> leading_;     // the chunks that lead to others, and
  std::vector<ChunkRange> children_;  // what each leads to
  std::vector<ChunkRange> parents_;   // by chunk, places in leading_
};

}  // namespace voyager
