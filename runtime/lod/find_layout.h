#pragma once
#include "runtime/base/progress.h"
#include "runtime/base/workers.h"
#include "runtime/lod/block_footprints.h"
#include "runtime/lod/layout.h"

namespace voyager {

// The tree that a rule makes of a cloud: a kd tree (kd_order.h) down to blocks, and in each block
// of a clustered tree what cluster.h finds. Each block has a footprint. Of a part of a cloud that
// is a node of that kd tree, with no fewer Gaussians than an exposure block, it is that node's part
// of the whole's tree. Depends on neither threads nor the standard library. Progress stages
// "splitting" and, of a clustered tree, "clustering".
TreeLayout find_layout(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                       const TreeRule& rule, Workers& workers, const Progress& progress = {},
                       const BlockFootprints& footprints = {});

}  // namespace voyager
