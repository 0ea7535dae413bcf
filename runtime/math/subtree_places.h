#pragma once
// Where a subtree of a streamed scene lies in tables that have room for resident subtrees, not for
// all of the file's. kPageSubtrees consecutive subtrees of the file are a page, which has a place
// in the tables while a chunk of it is resident. All pages that have none share the first place:
// there nothing leads to a subtree, and nothing is written.
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
