#pragma once
// Where tables by subtree have a streamed scene's: they have room for what is resident, not for
// all of the file. kPageSubtrees consecutive subtrees of the file are a page, which has a place in
// the tables while a chunk of it is resident. Place 0 stands for all that has none: nothing leads
// to its subtrees, and nothing is written there.
#include <cstdint>

#include "runtime/math/host_device.h"

namespace voyager {

// A chunk has some sixteen subtrees, and shares the first and the last page with its neighbours.
inline constexpr uint32_t kPageSubtrees = 8;

VOYAGER_HD constexpr uint32_t pages_of(uint32_t subtrees) {
  return subtrees / kPageSubtrees + (subtrees % kPageSubtrees != 0);
}

struct SubtreePlaces {
  const uint32_t* pages;  // by page of the file, its place; null where tables have all subtrees

  VOYAGER_HD uint32_t operator()(uint32_t subtree) const {
    return pages == nullptr
               ? subtree
               : pages[subtree / kPageSubtrees] * kPageSubtrees + subtree % kPageSubtrees;
  }
};

}  // namespace voyager
