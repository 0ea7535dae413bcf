#pragma once
// How the partitioned searches split their work. No result depends on these.
#include <cmath>
#include <cstdint>

#include "runtime/select/search_tree.h"
#include "runtime/select/watch.h"

namespace voyager {

inline constexpr uint32_t kBlockSubtrees = 512;  // 10 KiB of kept state
inline constexpr size_t kBlocksTask = 4;         // blocks: tiers may be small
inline constexpr size_t kRoundSubtrees = 256;    // of those just opened
inline constexpr size_t kChunksTask = 64;

// Temporal streams instead where more of the open subtrees are due. A visit costs the
// same in both; streaming adds a third for hulls and marks, repairing what it opens and
// closes. Measured on the district and a city of 1e6 (bench/NOTES.md): even from three
// quarters to nine tenths, and streaming up to 2.6 times as fast beyond.
inline constexpr double kStreamingShare = 0.85;

inline constexpr Watch kNever{INFINITY, 0};  // of a subtree that is closed
inline constexpr Watch kDue{-1, 0};  // of one that is to be visited, however little has moved

// How many blocks of so many subtrees there are: none has subtrees of two tiers.
inline uint64_t block_count(const SearchTree& tree, uint32_t subtrees) {
  uint64_t blocks = 0;
  for (size_t tier = 0; tier + 1 < tree.tier_begin.size(); ++tier)
    blocks += (tree.tier_begin[tier + 1] - tree.tier_begin[tier] + subtrees - 1) / subtrees;
  return blocks;
}

// visit(subtree, its place) for the subtrees [first, last). Tables of all subtrees have a loop of
// their own, since they are read often.
template <class Visit>
void each_place(SubtreePlaces places, uint32_t first, uint32_t last, const Visit& visit) {
  if (places.pages == nullptr)
    for (uint32_t s = first; s < last; ++s) visit(s, s);
  else
    for (uint32_t s = first; s < last; ++s) visit(s, places(s));
}

}  // namespace voyager
