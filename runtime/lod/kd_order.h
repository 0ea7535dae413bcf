#pragma once
#include <cstdint>
#include <vector>

#include "runtime/base/workers.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

// Indices of the cloud's Gaussians in kd order: the Gaussians of every node of
// the tree that runtime/lod/shape.h describes are contiguous. A node's are
// split at the median of their means along the longest side of the means'
// bounds, ties by index, then each part again; up to four of the last level
// keep the input's order. The order is unique: it depends on neither threads
// nor the standard library. Scratch: 8 bytes a Gaussian beside the result.
std::vector<uint32_t> kd_order(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                               Workers& workers);

}  // namespace voyager
