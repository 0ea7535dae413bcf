#pragma once
// What linking changes in a pool.
#include <optional>
#include <utility>
#include <vector>

#include "runtime/math/large_families.h"
#include "runtime/select/search_tree.h"
#include "runtime/stream/slot_ids.h"
#include "runtime/stream/subtree_pages.h"

namespace voyager {

// Changes of a SearchTree whose nodes and records are addresses, and of its nodes' parents.
// All of `cut`, `unlinked` and `left` is to be done before `pages`, and that before all of `tied`,
// `linked`, `outside` and `arrived`; in each, nothing is there twice with different values.
struct LinkPatch {
  struct Record {
    uint32_t record, children;  // SearchRecord::children
  };
  // What the nodes of a subtree hang from of which it does not own the parent.
  struct Outside {
    uint32_t subtree, parent;
  };
  // A chunk that has come: its slot, and what that holds now.
  struct Arrived {
    uint32_t slot, chunk;
    SlotIds ids;
  };
  struct Links {
    std::vector<Record> records;
    std::vector<uint32_t> changed;  // subtrees that hold those records
  };
  Links cut, tied;
  std::vector<uint32_t> unlinked;  // subtrees to which nothing leads any more; for their entries
  // Pages of subtrees that have another place. Nothing leads to what is there yet.
  std::vector<PageChange> pages;
  std::vector<std::pair<uint32_t, SearchSubtree>> linked;
  std::vector<Outside> outside;
  std::vector<uint32_t> left;  // slots of chunks that have gone
  std::vector<Arrived> arrived;
  // All large families of nodes that are held, where those have changed.
  std::optional<std::vector<LargeFamily>> large;

  bool empty() const {
    return cut.records.empty() && unlinked.empty() && pages.empty() && linked.empty() &&
           left.empty() && arrived.empty() && !large;
  }
};

}  // namespace voyager
