#pragma once
// Walks the subtrees of a partition in their order (runtime/lod/subtrees.h). Nodes
// ascend in each level, so that the counts of a subtree and the child counts of its
// nodes say which nodes it holds, which of them it repeats, and where the children
// of each start: this is what a .voy file leaves out, and what its reader checks.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/lod/subtrees.h"

namespace voyager {

// The levels of a tree and the subtrees of each tier, as in Partition.
struct Tiers {
  uint32_t first_tier_levels = 0;
  std::span<const uint32_t> level_begin;
  std::span<const uint32_t> tier_begin;

  // 0 without nodes.
  uint32_t node_count() const { return level_begin.empty() ? 0 : level_begin.back(); }
  uint32_t tier_count() const {
    return tier_begin.empty() ? 0 : static_cast<uint32_t>(tier_begin.size()) - 1;
  }
  // How many tiers the levels form.
  static uint32_t count_of(uint32_t levels, uint32_t first_tier_levels);
};

inline Tiers tiers_of(const Partition& partition) {
  return {partition.first_tier_levels, partition.level_begin, partition.tier_begin};
}

// A place between two subtrees: what those before it have left. After the last
// subtree of a tier it is the start of the next tier; after the last of all, every
// id is the number of nodes.
struct SubtreePlace {
  // The next node of each level of the tier: roots, children, grandchildren; then of
  // the roots of the tier below, as a child of a node of the last level. Where the
  // tier lacks a level: the first node of the tier below.
  uint32_t next[4];
  // Where root next[0] - 1 is continued in another run: how many of its children are
  // before this place, at least 1; else 0.
  uint32_t listed_children;
  // The same for child next[1] - 1 and its children.
  uint32_t listed_grandchildren;

  static SubtreePlace end_of(const Tiers& tiers) {
    const uint32_t end = tiers.node_count();
    return {{end, end, end, end}, 0, 0};
  }
  bool operator==(const SubtreePlace&) const = default;
};
static_assert(sizeof(SubtreePlace) == 24);

// Nodes [first, first + count).
struct NodeRange {
  uint32_t first, count;
};

// The levels of one tier, in the order of SubtreePlace::next; a tier of fewer than
// three has empty ranges for the rest.
struct TierLevels {
  uint32_t height;  // of them
  uint32_t begin[4], end[4];
};

// The nodes of a subtree on each level, as a file has them.
struct SubtreeCounts {
  uint8_t roots, children, grandchildren;
};
inline SubtreeCounts counts_of(const Subtree& subtree) {
  return {subtree.root_count, subtree.child_count, subtree.grandchild_count};
}

class SubtreeCursor {
 public:
  // Before the first subtree. What `tiers` refers to is sound and outlives the cursor.
  explicit SubtreeCursor(const Tiers& tiers) : tiers_(tiers) { start_tier(0); }

  // False, and nothing moved, where no subtree of that index can follow `place`.
  bool move_to(uint32_t subtree, const SubtreePlace& place);

  const SubtreePlace& place() const { return place_; }
  uint32_t subtree() const { return subtree_; }  // index of the next one
  bool at_end() const { return tier_ == tiers_.tier_count(); }

  // Reads the next subtree, of so many records by slot. That several roots hang from
  // one node is not seen here. Returns what is wrong with it, or nothing; after a fault
  // the cursor is of no more use. Safe for any counts and any records.
  const char* take(const SubtreeCounts& counts, const NodeRecord* records, Subtree& out);

  // Of the subtree last taken, by slot; meaningless for leaves and repeated nodes.
  const std::array<uint32_t, kSubtreeNodes>& first_children() const { return first_children_; }

 private:
  void start_tier(uint32_t tier);
  const char* take_roots(Subtree& out);
  const char* take_children(const NodeRecord* records, Subtree& out);
  const char* take_grandchildren(const NodeRecord* records, Subtree& out);
  const char* take_whole(const NodeRecord* records, uint32_t level, Subtree& out);
  const char* take_below(const NodeRecord* records, const Subtree& subtree);
  const char* finish(const NodeRecord* records, const Subtree& subtree);

  Tiers tiers_;
  uint32_t subtree_ = 0, tier_ = 0;
  TierLevels levels_{};  // of the tier
  SubtreePlace place_{};
  std::array<uint32_t, kSubtreeNodes> first_children_{};
};

// The nodes that the subtrees from one place to another own, ascending and disjoint.
// Both are places that a cursor can move to. Empty where `to` is not after `from`.
std::vector<NodeRange> nodes_between(const Tiers& tiers, const SubtreePlace& from,
                                     const SubtreePlace& to);
// How many those are.
uint64_t count_between(const Tiers& tiers, const SubtreePlace& from, const SubtreePlace& to);

}  // namespace voyager
