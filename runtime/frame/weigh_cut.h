#pragma once
#include <span>

#include "runtime/base/workers.h"
#include "runtime/select/partitioned.h"
#include "runtime/stages/interpolate.h"

namespace voyager {

// What of a tree weights read beside the search's records, by node.
struct NodeLinks {
  const uint32_t* parent;
  const uint32_t* child_count;  // null: the records'
  const NodeRecord* records;    // of leaves, where those have extents; of all without child_count
  float blend_share;            // LodTree's

  uint32_t children(uint32_t node) const {
    return child_count != nullptr ? child_count[node] : records[node].child_count;
  }
};

inline NodeLinks links_of(const LodTree& tree) {
  return {tree.parent.data(), nullptr, tree.records.data(), tree.blend_share};
}

// METHOD §4 over a cut that is known by subtree: items[i] draws search.cut()[i]. A
// parent's size is found once for its children, a node's own where it has an extent.
void weigh_cut(const NodeLinks& links, const SearchTree& search_tree,
               const PartitionedSearch& search, const CutQuery& query, std::span<DrawItem> items,
               Workers& workers);

}  // namespace voyager
