#pragma once
// What leads to what among the chunks that are resident. Nodes of one tier lead to subtrees
// of the next; a node does so only when all subtrees below it are there, and all that leads
// to itself, so that whatever search follows the links finds a cut that is whole.
#include <memory>
#include <optional>

#include "runtime/stream/by_chunk.h"
#include "runtime/stream/chunk_graph.h"
#include "runtime/stream/staged_chunk.h"
#include "runtime/stream/subtree_pages.h"

namespace voyager {

// Places in a slot, where a node's address is slot * that + its place, and what a chunk has of
// search records at most.
struct SlotShape {
  uint32_t nodes, records;
};

// Changes of a SearchTree whose nodes and records are addresses, and of its nodes' parents.
// All of `cut` and `unlinked` is to be done before `pages`, and that before all of `tied` and
// `linked`; in each, nothing is there twice with different values.
struct LinkPatch {
  struct Record {
    uint32_t record, children;  // SearchRecord::children
  };
  // The nodes [first, first + count) of a subtree, whose parent it does not own.
  struct Outside {
    uint32_t subtree, first, count, parent;
  };
  struct Links {
    std::vector<Record> records;
    std::vector<uint32_t> changed;  // subtrees that hold those records
  };
  Links cut, tied;
  std::vector<uint32_t> unlinked;  // subtrees to which nothing leads any more; for their entries
  // Pages of subtrees that have another place. Nothing leads to what is there yet.
  std::vector<PageChange> pages;
  std::vector<std::pair<uint32_t, SearchSubtree>> linked;
  std::vector<Outside> outside;
  // All large families of nodes that are held, where those have changed.
  std::optional<std::vector<LargeFamily>> large;

  bool empty() const {
    return cut.records.empty() && unlinked.empty() && pages.empty() && linked.empty() && !large;
  }
};

class Linker {
 public:
  // The graph outlives the linker.
  Linker(const ChunkGraph& graph, SlotShape shape);

  bool holds(uint32_t chunk) const { return tables_[chunk] != nullptr; }
  uint32_t slot(uint32_t chunk) const { return tables_[chunk]->slot; }
  // Of a chunk whose parents are all held: what it alone could not show, also that it goes on with
  // the tree's root where the chunk before was refused. Throws Error(damaged_chunk) as
  // stage_chunk() does.
  void check(const StagedChunk& chunk, const std::string& file) const;
  // A chunk whose parents are all held, in table.slot.
  void arrive(LinkTable&& table, LinkPatch& patch);
  // None of its children is held.
  void evict(uint32_t chunk, LinkPatch& patch);

 private:
  struct Family {
    uint32_t chunk, below;  // of the node that leads to it
  };

  const NodeBelow& below_of(const Family& family) const {
    return tables_[family.chunk]->below[family.below];
  }
  void check_roots(const LinkTable& own, const Subtree& subtree, const NodeRecord* records,
                   const std::string& file) const;
  Family family_of(uint32_t root) const;
  ChunkRange chunks_of(const Family& family) const;
  bool complete(const Family& family) const;
  // Each subtree of the family in turn: visit(table, index in it).
  template <class Visit>
  void each_subtree(const Family& family, const Visit& visit) const;
  template <class Work>
  void each_family_of(const LinkTable& table, const Work& work) const;
  void link(Family family, LinkPatch& patch);
  void unlink(Family family, LinkPatch& patch);
  void add_large(const LinkTable& table, LinkPatch& patch);
  void remove_large(const LinkTable& table, LinkPatch& patch);
  void link_root(LinkTable& table, uint32_t subtree, LinkPatch& patch);
  void add_below(const LinkTable& table, uint32_t subtree, std::vector<Family>& out) const;

  const ChunkGraph* graph_;
  SlotShape shape_;
  ByChunk<std::unique_ptr<LinkTable>> tables_;
  std::vector<LargeFamily> large_;  // of what is held, by address
  std::vector<Family> work_;
};

}  // namespace voyager
