#include "runtime/select/node_owners.h"

#include <bit>

namespace voyager {

// Nodes are numbered by tier, within it by level, and within that by subtree.
OwnerRuns make_owner_runs(const SearchTree& tree) {
  OwnerRuns made;
  for (size_t tier = 0; tier + 1 < tree.tier_begin.size(); ++tier)
    for (uint32_t level = 0; level < kTierLevels; ++level)
      for (uint32_t s = tree.tier_begin[tier]; s < tree.tier_begin[tier + 1]; ++s) {
        const SearchSubtree& subtree = tree.subtree(s);
        const uint32_t own = subtree.owned() & subtree.level_slots(level);
        if (own == 0) continue;
        const uint32_t first = subtree.node(static_cast<uint32_t>(std::countr_zero(own))),
                       last = first + count_bits(own) - 1;
        if (last / 32 >= made.runs.size()) made.runs.resize(last / 32 + 1);
        made.runs[first / 32].starts |= 1u << first % 32;
        made.subtrees.push_back(s);
      }
  number_runs(made.runs);
  return made;
}

}  // namespace voyager
