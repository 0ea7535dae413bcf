#pragma once
#include "runtime/base/workers.h"
#include "runtime/lod/layout.h"

namespace voyager {

// The tree that runtime/lod/shape.h describes, over the cloud in kd order
// (runtime/lod/kd_order.h). A node has kChildren children, or two or three where fewer
// parts remain.
TreeLayout kd_layout(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                     Workers& workers);

}  // namespace voyager
