#include "runtime/lod/round_bounds.h"

#include "runtime/math/bounds_code.h"

namespace voyager {

void round_bounds(LodTree& tree, Workers& workers) {
  constexpr size_t kNodesAtOnce = 8192;
  workers.for_blocks(tree.size(), kNodesAtOnce, [&](size_t begin, size_t end) {
    for (size_t n = begin; n < end; ++n) {
      NodeRecord& r = tree.records[n];
      if (r.child_count == 0) continue;
      const NodeBounds b = round_bounds(NodeBounds{r.box_min, r.extent, r.box_max});
      r = {b.box_min, b.extent, b.box_max, r.child_count};
    }
  });
}

}  // namespace voyager
