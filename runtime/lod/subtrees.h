#pragma once
// How the tree is cut up for the search and for storage (METHOD §9): subtrees of
// height at most 2, listed breadth-first, in chunks of contiguous subtrees.
//
// The levels of the tree form tiers of three: roots, children, grandchildren.
// Only the first tier may have fewer levels; how many it has is chosen so that
// there are as few subtrees as can be, since leaves on a level of roots are
// subtrees of one node each.
//
// A subtree holds at most kSubtreeNodes nodes, so that a word has a bit for each.
// One that would hold more is split into runs of consecutive children, with all
// of their children; each run but the first repeats the root. A child whose own
// children do not fit is split in the same way: each run after its first repeats
// the child, too. A repeated node is there to be compared with; the first run that
// holds it answers for it.
//
// Invariants:
//   - every node is in exactly one subtree that does not repeat it;
//   - subtrees are ordered by root, those of one root by their runs; so are, over
//     all subtrees, the children and the grandchildren that they hold;
//   - a subtree whose first child is one of several runs holds no other child.
#include <cstdint>
#include <memory_resource>
#include <span>
#include <string>
#include <vector>

#include "runtime/lod/tree.h"

namespace voyager {

inline constexpr uint32_t kSubtreeNodes = 31;
inline constexpr uint32_t kTierLevels = 3;

// Node ids are consecutive in each of the three levels. A node's place in the
// subtree is its slot: the root 0, then children, then grandchildren.
struct Subtree {
  uint32_t root;
  uint32_t first_child;       // meaningless without children
  uint32_t first_grandchild;  // meaningless without grandchildren
  uint8_t child_count;
  uint8_t grandchild_count;
  bool repeats_root;
  bool repeats_child;

  uint32_t node_count() const { return 1u + child_count + grandchild_count; }
  uint32_t node(uint32_t slot) const {
    if (slot == 0) return root;
    return slot <= child_count ? first_child + (slot - 1)
                               : first_grandchild + (slot - 1 - child_count);
  }
  bool repeats(uint32_t slot) const {
    return (slot == 0 && repeats_root) || (slot == 1 && repeats_child);
  }
  uint32_t first_owned() const { return node(repeats_child ? 2 : repeats_root ? 1 : 0); }
  bool operator==(const Subtree&) const = default;
};
static_assert(sizeof(Subtree) == 16);

// Bytes of uncompressed search records that a chunk may hold: a warp's part of the
// shared memory of an sm_87 multiprocessor at full residency. 164 KiB, less 1 KiB
// that the system keeps a block, over 3 blocks of 16 warps: 3434 bytes, which is
// 107 records.
inline constexpr uint32_t kDefaultChunkBytes = 3424;
// One subtree must fit.
inline constexpr uint32_t kMinChunkBytes = (kSubtreeNodes + 1) * sizeof(NodeRecord);
inline constexpr uint32_t kMaxChunkBytes = 1u << 20;

// Where a chunk is entered from: over its subtrees, the hull of the boxes and the
// greatest of the extents of the parents of the first node that each does not
// repeat. size(hull) ≥ size(parent) in binary32 for each of them, so that where
// size(hull) < τ* no node that the chunk owns is in the cut. For the tree's root, which
// has no parent, the extent is +inf, and so is the size.
struct EntryHull {
  Vec3f box_min;
  float extent;
  Vec3f box_max;

  float screen_size(const Vec3f& centre) const {
    return voyager::screen_size(centre, box_min, box_max, extent);
  }
};
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

// Appends the subtrees of a tier of `levels` levels whose roots are [begin, end).
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
