#pragma once
// The tree as the partitioned searches read it: subtree by subtree, and only what
// the cut depends on. A leaf is in the cut exactly where its parent is refined
// (sizes never grow from parent to child), so a leaf is a bit and has no record.
//
// Arrays are plain: the same bytes serve the CPU and the device.
#include <cstdint>
#include <functional>
#include <limits>
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/workers.h"
#include "runtime/lod/subtrees.h"
#include "runtime/math/bounds_code.h"
#include "runtime/math/nth_bit.h"
#include "runtime/math/subtree_places.h"

namespace voyager {

inline constexpr uint32_t kNoRecord = 0xffffffffu;
// In the place of an entry: nothing leads to the subtree now (runtime/stream/linker.h).
inline constexpr uint32_t kNotLinked = 0xfffffffeu;

// In SearchRecord::children, of a node on the lowest level of a tier: beside it is the first of the
// subtrees that have the node's children as their roots. No subtree has so high a number.
inline constexpr uint32_t kLowest = 0x80000000u;
// Of such a node, alone: the subtrees below are not there, so that the node stands in for them,
// however large it is.
inline constexpr uint32_t kBlocked = 0xffffffffu;

// An interior node in its subtree.
struct SearchRecord {
  uint32_t children;  // the slots of its children; kLowest or kBlocked on a tier's lowest level
  BoundsCode code;

  VOYAGER_HD NodeBounds bounds() const { return decode_bounds(code); }
  // The slots of its children in its own subtree.
  VOYAGER_HD uint32_t child_slots() const { return (children & kLowest) != 0 ? 0 : children; }
};
static_assert(sizeof(SearchRecord) == 16);

// Subtrees [first, last).
struct SubtreeSpan {
  uint32_t first, last;
};

// Records lie in blocks. In a pool those of a chunk are anywhere, and each says which block is the
// chunk's next.
inline constexpr uint32_t kRecordBlock = 4;
VOYAGER_HD constexpr uint32_t record_blocks(uint32_t records) {
  return (records + kRecordBlock - 1) / kRecordBlock;
}
// SearchSubtree::levels: where the slots of roots, of children and of all end, and the first that
// is not repeated.
inline constexpr uint32_t kScattered = 0x80000000u;  // beside them: records are not consecutive
VOYAGER_HD constexpr uint32_t slot_levels(uint32_t first_child_slot, uint32_t first_grandchild_slot,
                                          uint32_t slots, uint32_t first_owned_slot) {
  return first_child_slot | first_grandchild_slot << 8 | slots << 16 | first_owned_slot << 24;
}
VOYAGER_HD constexpr uint32_t slots_before(uint32_t slot) {
  return (1u << slot) - 1u;
}
// The slots of level 0, the roots', of 1, the children's, or of 2; used or not.
VOYAGER_HD constexpr uint32_t level_slots(uint32_t level, uint32_t levels) {
  const uint32_t roots = slots_before(levels & 0xff), upper = slots_before(levels >> 8 & 0xff);
  return level == 0 ? roots : level == 1 ? upper & ~roots : ~upper & 0x7fffffffu;
}

// The records that a cut node's weight depends on; kNoRecord for a leaf's own, and for the parent
// of the tree's root.
struct CutOrigin {
  uint32_t own, parent;
};

// Slots are those of Subtree. record(k) is that of the k-th slot in `interior`.
struct SearchSubtree {
  uint32_t root, first_child, first_grandchild;  // node ids
  uint32_t levels;                               // slot_levels(); 0 slots where it is missing
  uint32_t first_record;
  uint32_t interior;  // slots of interior nodes
  uint32_t families;  // slots of the first children here of nodes of the level above
  uint32_t entry;     // record of the roots' parent; kNoRecord at the tree's root

  VOYAGER_HD uint32_t slot_count() const { return levels >> 16 & 0xff; }
  // Its chunk is damaged.
  VOYAGER_HD bool missing() const { return slot_count() == 0; }
  VOYAGER_HD bool scattered() const { return (levels & kScattered) != 0; }
  // next_block: SearchTree's.
  VOYAGER_HD uint32_t record(uint32_t k, const uint32_t* next_block) const {
    if (!scattered()) return first_record + k;
    uint32_t block = first_record / kRecordBlock, place = first_record % kRecordBlock + k;
    for (; place >= kRecordBlock; place -= kRecordBlock) block = next_block[block];
    return block * kRecordBlock + place;
  }
  VOYAGER_HD uint32_t first_child_slot() const { return levels & 0xff; }
  VOYAGER_HD uint32_t first_grandchild_slot() const { return levels >> 8 & 0xff; }
  VOYAGER_HD uint32_t first_owned_slot() const { return levels >> 24 & 3; }
  // Slots that are not repeated.
  VOYAGER_HD uint32_t owned() const {
    return slots_before(slot_count()) & ~slots_before(first_owned_slot());
  }
  VOYAGER_HD uint32_t first_slot(uint32_t level) const {
    return level == 0 ? 0 : level == 1 ? first_child_slot() : first_grandchild_slot();
  }
  VOYAGER_HD uint32_t first_node(uint32_t level) const {
    return level == 0 ? root : level == 1 ? first_child : first_grandchild;
  }
  VOYAGER_HD uint32_t node(uint32_t slot) const {
    if (slot < first_child_slot()) return root + slot;
    return slot < first_grandchild_slot() ? first_child + (slot - first_child_slot())
                                          : first_grandchild + (slot - first_grandchild_slot());
  }
  VOYAGER_HD uint32_t level_slots(uint32_t level) const {
    return voyager::level_slots(level, levels);
  }
  VOYAGER_HD uint32_t level_of(uint32_t slot) const {
    return slot < first_child_slot() ? 0 : slot < first_grandchild_slot() ? 1 : 2;
  }
  // Of a node of a linked subtree that is not repeated. Of a repeated one node() may be any number.
  VOYAGER_HD uint32_t slot_of(uint32_t node) const {
    const uint32_t below = node - first_grandchild, middle = node - first_child;
    if (below < slot_count() - first_grandchild_slot()) return first_grandchild_slot() + below;
    return middle < first_grandchild_slot() - first_child_slot() ? first_child_slot() + middle
                                                                 : node - root;
  }
  // For a slot of level 1 or 2: which in `interior` is the slot that it hangs from.
  VOYAGER_HD uint32_t parent_rank(uint32_t slot) const {
    const uint32_t level = level_of(slot);
    const uint32_t above = level == 1 ? 0 : count_bits(interior & level_slots(0));
    return above + count_bits(families & level_slots(level) & slots_before(slot + 1)) - 1;
  }
  VOYAGER_HD CutOrigin origin(uint32_t slot, const uint32_t* next_block) const {
    const uint32_t own = count_bits(interior & slots_before(slot));
    return {(interior >> slot & 1) != 0 ? record(own, next_block) : kNoRecord,
            level_of(slot) == 0 ? entry : record(parent_rank(slot), next_block)};
  }
};
static_assert(sizeof(SearchSubtree) == 32);

// Of a subtree that has not come yet, or is missing.
inline constexpr SearchSubtree kUnlinkedSubtree{kNoNode, 0, 0, slot_levels(1, 1, 0, 0),
                                                0,       0, 0, kNotLinked};

// The subtrees below a record, which `children` is of: consecutive, and each has it as its entry.
VOYAGER_HD SubtreeSpan subtrees_below(const SearchSubtree* subtrees, SubtreePlaces places,
                                      uint32_t subtree_count, uint32_t record, uint32_t children) {
  if ((children & kLowest) == 0 || children == kBlocked) return {0, 0};
  const uint32_t first = children & ~kLowest;
  uint32_t last = first;
  while (last < subtree_count && subtrees[places(last)].entry == record) ++last;
  return {first, last};
}

// Hull of the records that the roots of a chunk hang from: no root can be reached
// where even the hull's size is under τ*, because every operation of size() is
// monotone. Those of chunks with subtrees of the tree's root are never under it.
struct SearchChunk {
  BoundsCode hull;
  uint32_t first_subtree, last_subtree;  // [first, last); of a pool's slot without a chunk: none
};
static_assert(sizeof(SearchChunk) == 20);

// A hull whose size is +inf wherever a camera may be.
inline constexpr NodeBounds kAlwaysReached{
    {-2 * kMaxCoordinate, -2 * kMaxCoordinate, -2 * kMaxCoordinate},
    std::numeric_limits<float>::max(),
    {2 * kMaxCoordinate, 2 * kMaxCoordinate, 2 * kMaxCoordinate}};

struct SearchTree {
  explicit SearchTree(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : subtrees(memory),
        pages(memory),
        records(memory),
        next_block(memory),
        chunks(memory),
        tier_begin(memory) {}

  uint32_t subtree_count() const { return tier_begin.empty() ? 0 : tier_begin.back(); }
  SubtreePlaces places() const { return {pages.empty() ? nullptr : pages.data()}; }
  const SearchSubtree& subtree(uint32_t s) const { return subtrees[places()(s)]; }
  SearchChunk chunk(uint32_t i) const { return chunks.empty() ? chunk_of(i) : chunks[i]; }
  // The one that a subtree is in, sought from one that may be near it. O(log n).
  uint32_t chunk_with(uint32_t subtree, uint32_t near) const;
  uint64_t bytes() const {
    return subtrees.size() * sizeof(SearchSubtree) + pages.size() * sizeof(uint32_t) +
           records.size() * sizeof(SearchRecord) + chunks.size() * sizeof(SearchChunk);
  }

  std::pmr::vector<SearchSubtree> subtrees;  // by place
  std::pmr::vector<uint32_t> pages;          // of a pool: SubtreePlaces::pages; else empty
  std::pmr::vector<SearchRecord> records;
  std::pmr::vector<uint32_t> next_block;  // by block of records, of a pool
  // None where a device has them, or where a file's directory tells (chunk_of).
  std::pmr::vector<SearchChunk> chunks;
  std::function<SearchChunk(uint32_t chunk)> chunk_of;  // any thread; asked where `chunks` is empty
  uint32_t chunk_count = 0;
  std::pmr::vector<uint32_t> tier_begin;  // first subtree of each tier, and the end
  bool leaves_have_extent = false;        // else a leaf's size is 0 wherever its weight matters
  bool chunks_come_and_go = false;  // records may be blocked, and the tree changes between runs
};

// Subtrees [first, last), whose chunk is damaged.
struct SubtreeRange {
  uint32_t first, last;
  uint32_t first_root;  // of subtree `first`
  bool repeats_root;    // which the subtree before has, too
};

// Tree and partition are sound where no chunk is damaged, and bounds are rounded (round_bounds()).
// missing: ascending and disjoint; nothing of those subtrees but their number is read from the
// partition. Throws only std::bad_alloc.
SearchTree make_search_tree(const LodTree& tree, const Partition& partition,
                            std::span<const SubtreeRange> missing, Workers& workers,
                            std::pmr::memory_resource* memory = std::pmr::get_default_resource());

}  // namespace voyager
