#pragma once
// Which pages of subtrees have a place in a pool's tables, and in those of the views that read it
// (runtime/math/subtree_places.h). A page keeps its place for some time after its last chunk has
// gone: a view that has not drawn since still has something there, which it closes when it follows
// what has changed.
#include <cstdint>
#include <set>
#include <unordered_map>
#include <utility>
#include <vector>

#include "runtime/math/subtree_places.h"
#include "runtime/stream/sparse_array.h"

namespace voyager {

// Of a page, its place from now on; 0: none.
struct PageChange {
  uint32_t page, place;
};

class SubtreePages {
 public:
  // room: places beside the first. kept: a view that has followed the last change but so many can
  // follow the next; any other forgets what it has.
  SubtreePages(uint32_t subtrees, uint32_t room, uint64_t kept);

  // The subtrees of a chunk that comes or goes with the change `version`. take() adds to `moved`
  // the pages that have another place. False: no view may go on from before that change, since it
  // may have something at a place that was taken. Throws Error(internal) where there is no place at
  // all.
  bool take(uint32_t first, uint32_t count, uint64_t version, std::vector<uint32_t>& moved);
  void release(uint32_t first, uint32_t count, uint64_t version);

  // Where those are now.
  std::vector<PageChange> changes(const std::vector<uint32_t>& moved) const;

 private:
  bool place_page(uint32_t page, uint64_t version, std::vector<uint32_t>& moved);

  const uint32_t room_;
  const uint64_t kept_;
  SparseArray<uint32_t> places_;  // by page
  SparseArray<uint8_t> chunks_;   // by page: that are there
  uint32_t used_ = 0;             // places that were ever taken
  // Those that have a place and no chunk, by the change with which that went; and the other way.
  std::set<std::pair<uint64_t, uint32_t>> released_;
  std::unordered_map<uint32_t, uint64_t> released_at_;
};

}  // namespace voyager
