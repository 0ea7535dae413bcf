#include <algorithm>

#include "runtime/select/cut.h"

namespace voyager {
namespace {

constexpr size_t kNodesAtOnce = 8192;  // 256 KiB of records, so a block's results stay in cache

}  // namespace

ExhaustiveSearch::ExhaustiveSearch(std::pmr::memory_resource* memory)
    : sizes_(memory), selected_(memory), blocks_(memory), cut_(memory) {}

void ExhaustiveSearch::run(const LodTree& tree, std::span<const MissingNodes> missing,
                           const CutQuery& query, Workers& workers) {
  const size_t nodes = tree.size();
  sizes_.resize(nodes);
  selected_.resize(nodes);
  blocks_.resize((nodes + kNodesAtOnce - 1) / kNodesAtOnce);
  cut_.reserve(nodes);
  workers.for_blocks(nodes, kNodesAtOnce,
                     [&](size_t begin, size_t end) { measure(tree, missing, query, begin, end); });
  workers.for_blocks(nodes, kNodesAtOnce, [&](size_t begin, size_t end) {
    blocks_[begin / kNodesAtOnce] = select(tree, query.target_size, begin, end);
  });
  nodes_tested_ = nodes;
  for (const MissingNodes& range : missing) nodes_tested_ -= range.count;
  gather();
}

void ExhaustiveSearch::measure(const LodTree& tree, std::span<const MissingNodes> missing,
                               const CutQuery& query, size_t begin, size_t end) {
  auto range = std::lower_bound(
      missing.begin(), missing.end(), begin,
      [](const MissingNodes& m, size_t node) { return size_t{m.first} + m.count <= node; });
  for (size_t n = begin; n < end;) {
    const size_t resident = range == missing.end() ? end : std::min<size_t>(end, range->first);
    for (; n < resident; ++n) {
      const NodeRecord& r = tree.records[n];
      sizes_[n] = screen_size(query.centre, r.box_min, r.box_max, r.extent);
    }
    if (n == end) return;
    const size_t last = std::min(end, size_t{range->first} + range->count);
    for (; n < last; ++n) sizes_[n] = kMissingSize;
    ++range;
  }
}

// Because sizes never grow from parent to child, a leaf with size ≥ τ* has a
// parent with size ≥ τ*: both ways into the cut go through a refined parent,
// and the root counts as the child of one. A missing child of a refined parent
// is what the cut lacks.
ExhaustiveSearch::BlockResult ExhaustiveSearch::select(const LodTree& tree, float target,
                                                       size_t begin, size_t end) {
  BlockResult result{0, kNoNode};
  for (size_t n = begin; n < end; ++n) {
    const uint32_t node = static_cast<uint32_t>(n), parent = tree.parent[n];
    if (parent == kNoNode ? node != 0 : !(sizes_[parent] >= target)) continue;
    if (sizes_[n] < 0.0f) {
      result.needed_missing = std::min(result.needed_missing, node);
    } else if (sizes_[n] < target || tree.is_leaf(node)) {
      selected_[begin + result.selected++] = node;
    }
  }
  return result;
}

void ExhaustiveSearch::gather() {
  size_t total = 0;
  needed_missing_ = kNoNode;
  for (const BlockResult& block : blocks_) {
    total += block.selected;
    needed_missing_ = std::min(needed_missing_, block.needed_missing);
  }
  cut_.resize(total);
  auto into = cut_.begin();
  for (size_t block = 0; block < blocks_.size(); ++block)
    into = std::copy_n(selected_.begin() + static_cast<std::ptrdiff_t>(block * kNodesAtOnce),
                       blocks_[block].selected, into);
}

}  // namespace voyager
