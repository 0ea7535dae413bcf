#pragma once
#include <cstdint>
#include <vector>

#include "runtime/base/workers.h"
#include "runtime/lod/shape.h"
#include "runtime/scene/gaussian_cloud.h"

namespace voyager {

// Indices of the cloud's Gaussians in kd order: the Gaussians of every node of
// the tree that the rule describes are contiguous. A node's are split at the
// median of their means along the longest side of the means' bounds (or of the
// boxes', leaf_box()), ties by index, then each part again; those of a block
// keep the input's order. The order is unique: it depends on neither threads
// nor the standard library. Scratch: 8 bytes a Gaussian beside the result.
std::vector<uint32_t> kd_order(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                               const KdRule& rule, Workers& workers);

}  // namespace voyager
