#pragma once
// What leads to what among the chunks that are resident. Nodes of one tier lead to subtrees
// of the next; a node does so only when all subtrees below it are there, and all that leads
// to itself, so that whatever search follows the links finds a cut that is whole.
//
// Of a chunk it keeps a LinkTable, and a large family's nodes in a list of all of them. Bounds of
// nodes are the pool's.
//
// Where cuts have room, what is linked follows from what is held alone. So the threads of a team
// link, and unlink, different chunks at once: a family is the thread's that sets or clears its
// mark.
#include <algorithm>
#include <compare>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/base/team.h"
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
  // One that has filled its slot.
  struct Arrival {
    StagedChunk* staged;  // empty once it is held
    uint32_t chunk;
    std::optional<Error> failure = {};  // damaged_chunk, as stage_chunk() has it
    bool held = false;  // without a failure: what it hangs from is not held, and maybe has failed
  };
  // Those whose parents are held, or come with them and in front of them. First what a chunk alone
  // could not show is checked, also that it goes on with the tree's root where the chunk before was
  // refused. divided: where families lie that hang from what is held now, of those that lie in
  // several chunks; in any order.
  void arrive(std::span<Arrival> chunks, const ChunkPool& pool, const std::string& file, Team& team,
              LinkPatch& patch, std::vector<ChunkRange>& divided);
  // No child of one is held that does not go with it. In a patch, chunks go before others come.
  void evict(std::span<const uint32_t> chunks, Team& team, LinkPatch& patch);
  // Behind all that goes and comes in a patch: what has room in a cut now, and had none.
  void link_refused(LinkPatch& patch);

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

  // What one thread of a team does of a commit.
  struct alignas(64) Lane {
    LinkPatch patch;
    std::vector<ChunkRange> divided;
    std::vector<Family> above;  // scratch
    // Families that hang from what is linked or unlinked: a heap, the first roots in front.
    std::vector<Family> work;
    uint64_t cut = 0, slots_linked = 0;  // more of most_cut_ and slots_linked_, modulo 2^64
  };
  struct Coming {
    Arrival* arrival;
    std::vector<Family> above;  // that its subtrees belong to, by their first roots
    bool before_was_held = false;
  };

  Walk walk(uint32_t chunk) const;
  Walk walk(const StagedChunk& chunk) const;
  RootWalk roots_of(const LinkTable& table) const { return {table, graph_->tiers()}; }
  void set_records(Walk& walk, SearchSubtree& subtree) const;
  static Walk last_of(Walk walk);  // its last subtree

  bool may_come(uint32_t chunk) const;
  void check(Coming& coming, const ChunkPool& pool, const std::string& file) const;
  void check_behind(const Coming& coming, const ChunkPool& pool, const std::string& file) const;
  void check_roots(const StagedChunk& chunk, const ChunkPool& pool, const std::string& file,
                   std::vector<Family>& above) const;
  void check_repeat(uint32_t chunk, Walk before, Walk after, const ChunkPool& pool,
                    const std::string& file) const;
  std::vector<Coming> hold_sound(std::span<Arrival> chunks, const ChunkPool& pool,
                                 const std::string& file, Team& team, LinkPatch& patch);
  void take_in(StagedChunk& chunk, LinkPatch& patch);
  void let_go(uint32_t chunk, LinkPatch& patch);
  void collect(LinkPatch& patch);

  bool complete(const Family& family) const;
  // Each subtree of the family in turn: visit(walk at it).
  template <class Visit>
  void each_subtree(const Family& family, Roots& roots, const Visit& visit) const;
  Family family_of(const Parent& parent, ChunkGraph::Families& families) const;
  bool may_lead_on(uint32_t chunk) const;
  void find_above(uint32_t chunk, std::vector<Family>& above) const;
  void find_divided(uint32_t chunk, std::vector<ChunkRange>& divided) const;
  // Of a lane, these families and all that hangs from them.
  void link(std::span<const Family> above, bool has_room, Lane& lane);
  void unlink(std::span<const Family> above, Lane& lane);
  void add_large(const StagedChunk& chunk);
  void remove_large(uint32_t slot);
  void tell_large(LinkPatch& patch);
  void link_root(uint32_t chunk, LinkPatch& patch);
  uint64_t ends_of(const Family& family, Roots& roots) const;
  bool has_room_for_cut(uint64_t cut, uint64_t ends) const {
    return cut - 1 + ends <= room_for_cut_;
  }
  bool has_room_for_all() const {
    return refused_.empty() && most_cut_ + (slots_held_ - slots_linked_) <= room_for_cut_;
  }
  bool refuse_if_large(const Family& family, Roots& roots, const Lane& lane);

  const ChunkGraph* graph_;
  SlotShape shape_;
  const std::vector<uint32_t>* next_block_;
  ByChunk<LinkTable> tables_;
  std::vector<LargeFamily> large_;  // of what is held, by address
  bool large_changed_ = false;      // by this commit
  std::vector<Lane> lanes_{1};      // scratch
  // Of what is linked: that no cut has more nodes, those which nothing leads on from.
  uint64_t most_cut_ = 0, room_for_cut_ = UINT64_MAX;
  uint64_t slots_held_ = 0, slots_linked_ = 0;  // of subtrees: of all, and of what is linked
  std::set<Refused> refused_;
};

}  // namespace voyager
