#pragma once
// The splits above the cells, found without holding more than a part of the means: the
// medians that kd_order() finds, by counting in ever narrower bins and then choosing
// among the few that are left.
#include <vector>

#include "runtime/bake/spool.h"
#include "runtime/lod/shape.h"

namespace voyager {

// A perfect binary tree of splits, two levels of it for each of the LoD tree's, down to
// the cells.
class SplitTree {
 public:
  struct Split {
    int axis;
    // The first of the upper side, in the order by (coordinate, index).
    float key;
    uint32_t index;
  };

  uint32_t cell_level() const { return depth_ / 2; }
  uint32_t cells() const { return 1u << depth_; }
  // The node on level `depth_` over a Gaussian, from 0, through the levels above.
  uint32_t node_of(const Vec3f& mean, uint32_t index) const {
    uint32_t node = 1;
    for (uint32_t level = 0; level < depth_; ++level) {
      const Split& s = splits_[node];
      const float key = mean[s.axis];
      const bool lower = key < s.key || (key == s.key && index < s.index);
      node = 2 * node + (lower ? 0 : 1);
    }
    return node - (1u << depth_);
  }
  // One level more, its splits in order.
  void add_level(const std::vector<Split>& splits);

 private:
  uint32_t depth_ = 0;
  std::vector<Split> splits_{{0, 0, 0}};  // of heap node i; 0 is none
};

// The scene's origin, as build_tree() chooses it.
std::array<double, 3> origin_of(const SpoolInfo& spool, const WorkFolder& folder);

// Splits down to the cells of a level: node_of() is then the cell. In about `memory` bytes.
// Throws Error(refused_input) for means that build_tree() refuses. Progress stage
// "splitting".
SplitTree find_medians(const SpoolInfo& spool, uint32_t cell_level, const KdRule& rule,
                       const WorkFolder& folder, const std::array<double, 3>& origin,
                       uint64_t memory, Workers& workers, const Progress& progress);

}  // namespace voyager
