#pragma once
// Which pages of subtrees have a place in a pool's tables, and in those of the views that read it
// (runtime/math/subtree_places.h). A page keeps its place for some time after its last chunk has
// gone: a view that has not drawn since still has something there, which it closes when it follows
// what has changed.
#include <cstdint>
#include <deque>
#include <optional>
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
  struct Page {
    // In released_, with which change the last of its chunks went; 0: it is not there.
    uint64_t released_at = 0;
    uint32_t place = 0;
    uint32_t chunks = 0;  // that are there

    bool operator==(const Page&) const = default;
  };
  struct Released {
    uint64_t at;
    uint32_t page;
  };

  bool place_page(uint32_t page, uint64_t version, std::vector<uint32_t>& moved);
  bool forget_if_taken(const Released& released);
  std::optional<Released> take_released();

  const uint32_t room_;
  const uint64_t kept_;
  SparseArray<Page> pages_;
  uint32_t used_ = 0;  // places that were ever taken
  // By the change, and some that have chunks again.
  std::deque<Released> released_;
  uint64_t sorted_ = 0;  // the first of those that went with this change are sorted by page
};

}  // namespace voyager
