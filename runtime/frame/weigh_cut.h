#pragma once
#include <span>

#include "runtime/base/workers.h"
#include "runtime/frame/node_links.h"
#include "runtime/select/partitioned.h"
#include "runtime/stages/interpolate.h"

namespace voyager {

// METHOD §4 over a cut that is known by subtree: items[i] draws search.cut()[i]. A
// parent's size is found once for its children, a node's own where it has an extent.
void weigh_cut(const NodeLinks& links, const SearchTree& search_tree,
               const PartitionedSearch& search, const CutQuery& query, std::span<DrawItem> items,
               Workers& workers);

}  // namespace voyager
