#pragma once
// The LoD tree (METHOD §2), as the search reads it.
//
// Node ids are breadth-first: the root is 0, the children of a node are
// contiguous, and those of node n come directly after those of node n - 1.
// Node ids are also the order of nodes in a .hier export.
//
// Invariants (runtime/lod/validate.h checks them):
//   - a leaf has no children, and its box covers mean ± 3·max(s), both ends
//     computed in binary32 from the activated Gaussian;
//   - a node's box contains its children's boxes;
//   - extent is ≥ 0, may be +inf, and never grows from parent to child (box nesting
//     and this make size(child) ≤ size(parent) in binary32);
//     a tree built as HierarchicalGS does (tree_rule.h) has the box's longest side, 0 for a leaf;
//   - everything is binary32 in scene-local metres; coordinates are finite, below 1e18.
#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/math/screen_size.h"

namespace voyager {

inline constexpr uint32_t kNoNode = 0xffffffffu;

// A node apart from its Gaussian, as a file has it. Searches read less (select/search_tree.h).
struct NodeRecord {
  Vec3f box_min;
  float extent;
  Vec3f box_max;
  uint32_t child_count;
};
static_assert(sizeof(NodeRecord) == 32);

struct LodTree {
  explicit LodTree(std::pmr::memory_resource* memory = std::pmr::get_default_resource())
      : records(memory), first_child(memory), parent(memory) {}

  size_t size() const { return records.size(); }
  bool is_leaf(uint32_t n) const { return records[n].child_count == 0; }
  float screen_size(uint32_t n, const Vec3f& centre) const {
    const NodeRecord& r = records[n];
    return voyager::screen_size(centre, r.box_min, r.box_max, r.extent);
  }

  std::pmr::vector<NodeRecord> records;
  std::pmr::vector<uint32_t> first_child;  // meaningless for a leaf
  std::pmr::vector<uint32_t> parent;       // kNoNode for the root
  float blend_share = 0.5f;  // β of METHOD §4: of a parent's size, where a cut blends with it
};

}  // namespace voyager
