#pragma once
// Which chunks lead to which: a chunk's nodes hang from those of its parents. Found from
// the directory alone, since nodes are numbered breadth-first, so that children are consecutive
// chunks, and parents but for those that lead nowhere.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>

#include "runtime/format/chunk_directory.h"
#include "runtime/stream/chunk_ranges.h"

namespace voyager {

class ChunkGraph {
 public:
  class Parents {
   public:
    // Those of the chunks that lead somewhere.
    Parents(ChunkRange among, const ChunkRanges* children) : among_(among), children_(children) {}
    class Iterator {
     public:
      using iterator_category = std::forward_iterator_tag;
      using value_type = uint32_t;
      using difference_type = std::ptrdiff_t;
      using pointer = void;
      using reference = uint32_t;

      Iterator(uint32_t chunk, const Parents* of) : chunk_(chunk), of_(of) { skip(); }
      uint32_t operator*() const { return chunk_; }
      Iterator& operator++() {
        ++chunk_;
        skip();
        return *this;
      }
      bool operator==(const Iterator& other) const { return chunk_ == other.chunk_; }

     private:
      void skip() {
        while (chunk_ != of_->among_.last && of_->children_->is_empty(chunk_)) ++chunk_;
      }

      uint32_t chunk_;
      const Parents* of_;
    };
    Iterator begin() const { return {among_.first, this}; }
    Iterator end() const { return {among_.last, this}; }

   private:
    ChunkRange among_;
    const ChunkRanges* children_;
  };

  // A directory as SceneFile checks it, which outlives the graph, as what tiers refers to.
  // O(n log n).
  ChunkGraph(const ChunkDirectory& chunks, const Tiers& tiers);

  uint32_t size() const { return static_cast<uint32_t>(chunks_->size()); }
  const Tiers& tiers() const { return tiers_; }
  // Ascending, each before the chunk, and none before `from`; none where it holds the tree's root
  // and all that it leads to hangs from itself. Between them may be chunks that lead nowhere: on a
  // level with few nodes a chunk hangs from places far apart, and what is between is none of its
  // business.
  Parents parents(uint32_t chunk, uint32_t from = 0) const {
    const ChunkRange among = parents_[chunk];
    return Parents{{std::clamp(from, among.first, among.last), among.last}, &children_};
  }
  bool has_parents(uint32_t chunk) const { return !parents_.is_empty(chunk); }
  // Each behind the chunk: those that it is a parent of, and no other.
  ChunkRange children(uint32_t chunk) const { return children_[chunk]; }
  // The chunks whose subtrees have these nodes as their roots: [first, first + count) on a level
  // of roots, but for the tree's. Of no nodes: the one that has roots on either side of first.
  ChunkRange with_roots(uint32_t first, uint32_t count) const {
    return with_roots(first, count, {0, size()});
  }
  // The same of the children of a node that `chunk` owns. Costs by how many chunks it leads to.
  ChunkRange with_family(uint32_t chunk, uint32_t first, uint32_t count) const;
  // The same where each family probably lies in one chunk with the one before, which costs little.
  class Families {
   public:
    explicit Families(const ChunkGraph& graph) : graph_(&graph) {}
    // near: the chunk that the first is sought in.
    Families(const ChunkGraph& graph, uint32_t near) : graph_(&graph) { go_to(near); }
    ChunkRange of(uint32_t chunk, uint32_t first, uint32_t count) {
      if (first >= begin_ && first + count <= end_) return {near_, near_ + 1};
      const ChunkRange range = graph_->with_family(chunk, first, count);
      if (!range.empty()) go_to(range.last - 1);
      return range;
    }

   private:
    void go_to(uint32_t chunk);

    const ChunkGraph* graph_;
    uint32_t near_ = 0;
    uint32_t begin_ = 0, end_ = 0;  // of the roots that are in that chunk alone
  };
  // Whether some of what hangs from a chunk may be in that chunk.
  bool leads_to_itself(uint32_t chunk) const;
  // Where the first subtree of a chunk repeats a child, that one.
  uint32_t repeated_child(uint32_t chunk) const { return chunks_->next(chunk, 1) - 1; }
  // Roots that hang from the chunks before it are before this one.
  uint32_t next_below(uint32_t chunk) const { return chunks_->next(chunk, 3); }
  // The chunk that owns the parent of a root of `chunk`, which is not the tree's. Costs by how many
  // parents that has.
  uint32_t owner_of_parent(uint32_t chunk, uint32_t root) const;

 private:
  ChunkRange with_roots(uint32_t first, uint32_t count, ChunkRange among) const;
  ChunkRange find_children(uint32_t chunk, uint32_t near) const;
  ChunkRange among_parents(uint32_t chunk, ChunkRange near) const;
  uint32_t owner_near(uint32_t root, uint32_t near) const;
  bool leads_beyond(uint32_t chunk, uint32_t root) const;
  uint32_t first_root(uint32_t chunk) const;
  uint32_t last_root(uint32_t chunk) const;
  uint32_t next_after(uint32_t chunk, int level) const;
  uint32_t tier_of(uint32_t subtree) const;

  const ChunkDirectory* chunks_;
  Tiers tiers_;
  ChunkRanges children_;
  ChunkRanges parents_;  // from the first to the last, with those between that lead nowhere
};

}  // namespace voyager
