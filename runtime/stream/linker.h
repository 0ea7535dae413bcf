#pragma once
// What leads to what among the chunks that are resident. Nodes of one tier lead to subtrees
// of the next; a node does so only when all subtrees below it are there, and all that leads
// to itself, so that whatever search follows the links finds a cut that is whole.
//
// Of a chunk it keeps a LinkTable, and a large family's nodes in a list of all of them. Bounds of
// nodes are the pool's.
#include <algorithm>
#include <compare>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "runtime/stream/by_chunk.h"
#include "runtime/stream/chunk_graph.h"
#include "runtime/stream/chunk_pool.h"

namespace voyager {

class Linker {
 public:
  // graph and next_block outlive it. next_block: of each block of records, the chunk's next.
  Linker(const ChunkGraph& graph, SlotShape shape, const std::vector<uint32_t>& next_block);
  // What it takes at most where a pool has so much room: a subtree has a place, and a node of a
  // tier's lowest level a record.
  static PoolBytes bytes(SlotShape shape);
  // No more chunks will be held, and views have room for cuts of so many nodes: what could make
  // them larger is not linked before there is room for it.
  void make_room(PoolRoom room, uint64_t cut_nodes) {
    tables_.reserve(room.slots);
    large_.reserve(room.families);
    room_for_cut_ = cut_nodes;
  }
  // Whether something is not linked for that reason alone.
  bool lacks_room_for_cut() const { return !refused_.empty(); }
  // Whether that is so of a family with such a chunk.
  template <class Such>
  bool refuses(const Such& such) const {
    return std::any_of(refused_.begin(), refused_.end(), [&](const Refused& refused) {
      const ChunkRange range = refused.family.chunks;
      for (uint32_t chunk = range.first; chunk < range.last; ++chunk)
        if (such(chunk)) return true;
      return false;
    });
  }

  bool holds(uint32_t chunk) const { return !tables_[chunk].empty(); }
  uint32_t slot(uint32_t chunk) const { return tables_[chunk].slot; }
  // Of a chunk whose parents are all held, and that has filled its slot: what it alone could not
  // show, also that it goes on with the tree's root where the chunk before was refused. Throws
  // Error(damaged_chunk) as stage_chunk() does.
  void check(const StagedChunk& chunk, const ChunkPool& pool, const std::string& file);
  // A chunk whose parents are all held, in links.slot. Costs less where it was checked just before.
  void arrive(StagedChunk&& chunk, LinkPatch& patch);
  // None of its children is held. In a patch, chunks go before others come.
  void evict(uint32_t chunk, LinkPatch& patch);
  // Behind all that goes and comes in a patch: what has room in a cut now, and had none.
  void link_refused(LinkPatch& patch);

  // Where the families are that hang from a chunk that is held, of those that lie in several
  // chunks: visit(ChunkRange).
  template <class Visit>
  void each_divided_family(uint32_t chunk, const Visit& visit) const {
    if (graph_->children(chunk).empty()) return;
    ChunkGraph::Families families(*graph_, chunk);
    for (LinkWalk at = walk(chunk).at; !at.at_end(); at.next())
      at.each_below([&](const NodeBelow& node) {
        const ChunkRange range = families.of(chunk, node.first_child, node.child_count);
        if (range.last - range.first > 1) visit(range);
      });
  }

 private:
  // A node of a tier's lowest level that has children; with where these lie it is a family.
  struct Parent {
    uint32_t chunk, subtree;  // an index in the chunk
    uint32_t record;          // its address
    NodeBelow node;

    uint32_t end() const { return node.first_child + node.child_count; }
  };
  struct Family : Parent {
    ChunkRange chunks;  // that the children's subtrees lie in
  };
  // One that is all there, and that a linked subtree would lead to if a cut had room for it.
  struct Refused {
    uint64_t ends;  // as ends_of() counts them
    Family family;

    // The smallest is first, so that nothing has room where that has none.
    std::strong_ordering operator<=>(const Refused& other) const {
      if (const auto order = ends <=> other.ends; order != 0) return order;
      if (const auto order = family.chunk <=> other.family.chunk; order != 0) return order;
      return family.node.index <=> other.family.node.index;
    }
  };
  // Addresses of a chunk's records. Numbers that ascend go through its blocks once, others from the
  // first block again.
  class Records {
   public:
    Records(const std::vector<uint32_t>& next_block, uint32_t first_block)
        : next_block_(&next_block), first_block_(first_block), block_(first_block) {}
    uint32_t operator()(uint32_t number) {
      const uint32_t before = number / kRecordBlock;
      if (before < before_) {
        block_ = first_block_;
        before_ = 0;
      }
      for (; before_ != before; ++before_) block_ = (*next_block_)[block_];
      return block_ * kRecordBlock + number % kRecordBlock;
    }

   private:
    const std::vector<uint32_t>* next_block_;
    uint32_t first_block_, block_;
    uint32_t before_ = 0;  // blocks before that
  };
  struct Walk {
    uint32_t chunk;
    LinkWalk at;
    Records records;
  };
  // Finds what a root hangs from. Roots that ascend go through a chunk once.
  class Parents;
  // Finds a root in a chunk. Roots that ascend go through it once.
  class Roots;

  Walk walk(uint32_t chunk) const;
  Walk walk(const StagedChunk& chunk) const;
  RootWalk roots_of(const LinkTable& table) const { return {table, graph_->tiers()}; }
  void set_records(Walk& walk, SearchSubtree& subtree) const;
  void check_roots(const StagedChunk& chunk, const ChunkPool& pool, const std::string& file);
  void check_repeat(uint32_t chunk, Walk before, Walk after, const ChunkPool& pool,
                    const std::string& file) const;
  bool complete(const Family& family) const;
  // Each subtree of the family in turn: visit(walk at it).
  template <class Visit>
  void each_subtree(const Family& family, Roots& roots, const Visit& visit) const;
  Family family_of(const Parent& parent, ChunkGraph::Families& families) const;
  void add_work(const Family& family);
  bool has_work() const { return next_above_ != above_.size() || !work_.empty(); }
  Family take_work();
  bool may_lead_on(uint32_t chunk) const;
  void find_above(uint32_t chunk);
  void link(LinkPatch& patch);
  void unlink(LinkPatch& patch);
  void add_large(const StagedChunk& chunk, LinkPatch& patch);
  void remove_large(uint32_t slot, LinkPatch& patch);
  void link_root(uint32_t chunk, LinkPatch& patch);
  uint64_t ends_of(const Family& family, Roots& roots) const;
  bool has_room_for_cut(uint64_t ends) const { return most_cut_ - 1 + ends <= room_for_cut_; }
  bool refuse_if_large(const Family& family, Roots& roots);

  const ChunkGraph* graph_;
  SlotShape shape_;
  const std::vector<uint32_t>* next_block_;
  ByChunk<LinkTable> tables_;
  std::vector<LargeFamily> large_;  // of what is held, by address
  // Families that the subtrees of one chunk belong to, by their first roots. Those before
  // next_above_ are done.
  std::vector<Family> above_;
  size_t next_above_ = 0;
  // Those of the chunk that was checked last, until it arrives.
  std::vector<Family> checked_above_;
  static constexpr uint32_t kNone = 0xffffffffu;
  uint32_t checked_ = kNone;
  // Families that hang from what is linked or unlinked: a heap, the first roots in front.
  std::vector<Family> work_;
  // Of what is linked: that no cut has more nodes, those which nothing leads on from.
  uint64_t most_cut_ = 0, room_for_cut_ = UINT64_MAX;
  std::set<Refused> refused_;
};

}  // namespace voyager
