#pragma once
// How the tree is cut up for the search and for storage (METHOD §9): subtrees of
// height at most 2, listed breadth-first, in chunks of contiguous subtrees.
//
// The levels of the tree form tiers of three: roots, children, grandchildren.
// Only the first tier may have fewer levels; how many it has is chosen so that
// there are as few subtrees as can be, before siblings share them.
//
// A subtree holds at most kSubtreeNodes nodes, so that a word has a bit for each.
// A root with more below it is split into runs of consecutive children, with all
// of their children; each run but the first repeats the root. A child whose own
// children do not fit is split in the same way: each run after its first repeats
// the child, too. A repeated node is there to be compared with; the first run that
// holds it answers for it.
//
// Siblings whose subtrees are neighbours in a chunk share one (SiblingRule): else a leaf
// on a level of roots would be a subtree of one node, as three in five would be.
//
// Invariants:
//   - every node is in exactly one subtree that does not repeat it;
//   - subtrees are ordered by root, those of one root by their runs; so are, over
//     all subtrees, the children and the grandchildren that they hold;
//   - the roots of a subtree hang from one node; where they are several, it has all
//     that is below them in the tier;
//   - a subtree whose first child is one of several runs holds no other child.
#include <algorithm>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <string>
#include <vector>

#include "runtime/lod/tree.h"

namespace voyager {

inline constexpr uint32_t kSubtreeNodes = 31;
inline constexpr uint32_t kTierLevels = 3;

// What of a subtree the subtrees before it have, too.
enum class Repeats : uint8_t { nothing, root, root_and_child };

// Node ids are consecutive in each of the three levels. A node's place in the
// subtree is its slot: roots, then children, then grandchildren.
struct Subtree {
  uint32_t root;              // the first
  uint32_t first_child;       // meaningless without children
  uint32_t first_grandchild;  // meaningless without grandchildren
  uint8_t root_count, child_count, grandchild_count;
  Repeats repeated;  // of a subtree with several roots nothing

  uint32_t first_child_slot() const { return root_count; }
  uint32_t first_grandchild_slot() const { return uint32_t{root_count} + child_count; }
  // Of a level; of level 3 the end.
  uint32_t first_slot(uint32_t level) const {
    const uint32_t first[] = {0, first_child_slot(), first_grandchild_slot(), node_count()};
    return first[level];
  }
  uint32_t node_count() const { return first_grandchild_slot() + grandchild_count; }
  // 0: roots, 1: children, 2: grandchildren.
  uint32_t level(uint32_t slot) const {
    return (slot >= first_child_slot() ? 1u : 0u) + (slot >= first_grandchild_slot() ? 1u : 0u);
  }
  uint32_t node(uint32_t slot) const {
    if (slot < first_child_slot()) return root + slot;
    return slot < first_grandchild_slot() ? first_child + (slot - first_child_slot())
                                          : first_grandchild + (slot - first_grandchild_slot());
  }
  bool repeats_root() const { return repeated != Repeats::nothing; }
  bool repeats_child() const { return repeated == Repeats::root_and_child; }
  // The first slot that is not repeated: 0, 1 or 2.
  uint32_t first_owned_slot() const { return static_cast<uint32_t>(repeated); }
  uint32_t first_owned() const { return node(first_owned_slot()); }
  bool repeats(uint32_t slot) const { return slot < first_owned_slot(); }
  bool operator==(const Subtree&) const = default;
};
static_assert(sizeof(Subtree) == 16);

// Who is whose child among a subtree's slots: each(parent, first child, children) for every slot
// above the lowest level in use, in order; the children are those that this subtree lists.
// child_count(slot) is the node's. Safe for any counts.
template <class ChildCount, class Each>
void each_family(const Subtree& subtree, const ChildCount& child_count, const Each& each) {
  uint32_t next = subtree.first_child_slot();
  const auto list = [&](uint32_t slot, bool only, uint32_t end) {
    const uint32_t left = end - next;
    // One alone on its level may have the others in further runs.
    const uint32_t listed = only ? left : std::min<uint32_t>(child_count(slot), left);
    each(slot, next, listed);
    next += listed;
  };
  const bool one_root = subtree.root_count == 1;
  for (uint32_t slot = 0; slot < subtree.first_child_slot(); ++slot)
    list(slot, one_root, subtree.first_grandchild_slot());
  next = subtree.first_grandchild_slot();
  for (uint32_t slot = subtree.first_child_slot(); slot < subtree.first_grandchild_slot(); ++slot)
    list(slot, one_root && subtree.child_count == 1, subtree.node_count());
}

// Bytes of uncompressed records that a chunk may hold: a warp's part of the
// shared memory of an sm_87 multiprocessor at full residency. 164 KiB, less 1 KiB
// that the system keeps a block, over 3 blocks of 16 warps: 3434 bytes, which is
// 107 records.
inline constexpr uint32_t kDefaultChunkBytes = 3424;
// One subtree must fit.
inline constexpr uint32_t kMinChunkBytes = (kSubtreeNodes + 1) * sizeof(NodeRecord);
inline constexpr uint32_t kMaxChunkBytes = 1u << 20;

// Where a chunk is entered from: over its subtrees, the hull of the boxes and the
// greatest of the extents of the parents of the first node that each does not
// repeat. size(hull) ≥ size(parent) in binary32 for each of them, and for their rounded bounds and
// a rounded hull (math/bounds_code.h). So where that is < τ* no node that the chunk owns is in the
// cut. For the tree's root, which has no parent, the extent is +inf, and so is the size.
using EntryHull = NodeBounds;
static_assert(sizeof(EntryHull) == 28);

struct Partition {
  explicit Partition(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : subtrees(memory),
        level_begin(memory),
        tier_begin(memory),
        chunk_begin(memory),
        chunk_hull(memory) {}

  size_t chunk_count() const { return chunk_begin.empty() ? 0 : chunk_begin.size() - 1; }

  uint32_t first_tier_levels = 0;             // 1 to 3; 0 without nodes
  uint32_t chunk_bytes = kDefaultChunkBytes;  // what chunks were packed for
  std::pmr::vector<Subtree> subtrees;
  // Each with its end as a last entry; empty for an empty tree.
  std::pmr::vector<uint32_t> level_begin;  // first node of each level
  std::pmr::vector<uint32_t> tier_begin;   // first subtree of each tier
  std::pmr::vector<uint32_t> chunk_begin;  // first subtree of each chunk

  std::pmr::vector<EntryHull> chunk_hull;  // of each chunk
};

// A hull over one entry parent, and one over two: the first of equal values stays.
EntryHull hull_of(const NodeRecord& parent);
EntryHull hull_of_root(const NodeRecord& root);  // which has no parent
EntryHull join(const EntryHull& a, const EntryHull& b);

// Which of consecutive roots share a subtree: those that hang from one node, while there is room,
// but no two neighbours that both have grandchildren in the tier. (A bake in parts relies on this:
// it does not see that the roots of two cells are siblings, and both have grandchildren.)
class SiblingRule {
 public:
  // Of a root with all that is below it in the tier, so many nodes: whether it shares that of the
  // root before. sibling: hangs from the same node. deep: has grandchildren.
  bool shares(uint32_t nodes, bool sibling, bool deep) {
    const bool shared = sibling && !(deep && deep_) && nodes_ + nodes <= kSubtreeNodes;
    nodes_ = nodes + (shared ? nodes_ : 0);
    deep_ = deep;
    return shared;
  }
  // The next root shares nothing with what is before it: a chunk begins, or a root was split.
  void start() { nodes_ = kSubtreeNodes; }

 private:
  uint32_t nodes_ = kSubtreeNodes;
  bool deep_ = false;
};

// Joins the subtrees of each chunk, in their order, as SiblingRule says; roots whose parent is
// kNoNode with none. chunk_begin: the first of each, and the end.
void join_siblings(const LodTree& tree, std::span<uint32_t> chunk_begin,
                   std::pmr::vector<Subtree>& subtrees);

// Appends the subtrees of a tier of `levels` levels whose roots are [begin, end), one root in each.
void split_tier(const LodTree& tree, uint32_t levels, uint32_t begin, uint32_t end,
                std::pmr::vector<Subtree>& out);

// The tree is sound (runtime/lod/validate.h). chunk_bytes from kMinChunkBytes to
// kMaxChunkBytes. O(n); throws only std::bad_alloc.
Partition partition_tree(const LodTree& tree, uint32_t chunk_bytes,
                         std::pmr::memory_resource* memory = std::pmr::get_default_resource());

// Every way in which the partition is not one of that tree, or breaks the invariants
// above (at most `limit` of them), each naming place, found and expected. The tree is
// sound; safe for any content of the partition. O(n).
std::vector<std::string> validate(const Partition& partition, const LodTree& tree,
                                  size_t limit = 16);

// First items of the fewest contiguous runs whose sizes each sum to at most `limit`,
// and the number of items as a last entry; each size is at most `limit`. Next-fit:
// a run ends only where the next item does not fit, and no packing of contiguous
// runs can be ahead of it.
std::pmr::vector<uint32_t> pack_runs(
    std::span<const uint32_t> sizes, uint32_t limit,
    std::pmr::memory_resource* memory = std::pmr::get_default_resource());

}  // namespace voyager
