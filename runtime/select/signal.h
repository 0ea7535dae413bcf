#pragma once
// What a visit tells the subtrees below.

#include "runtime/select/search_tree.h"
#include "runtime/select/set_bits.h"

namespace voyager {

// opened(first, last) and closed(first, last) for the subtrees below each slot of
// `flipped`, in ascending order, by what the slot now is in `refined`.
template <class Opened, class Closed>
void signal_below(const SearchTree& tree, uint32_t subtree, uint32_t flipped, uint32_t refined,
                  const Opened& opened, const Closed& closed) {
  const SearchSubtree& s = tree.subtree(subtree);
  for (; flipped != 0; flipped &= flipped - 1) {
    const uint32_t slot = flipped & (~flipped + 1);
    const uint32_t record = s.record(count_bits(s.interior & (slot - 1)), tree.next_block.data());
    const auto [first, last] =
        subtrees_below(tree.subtrees.data(), tree.places(), tree.subtree_count(), record,
                       tree.records[record].children);
    if (first == last) continue;
    if ((refined & slot) != 0)
      opened(first, last);
    else
      closed(first, last);
  }
}

}  // namespace voyager
