#pragma once
// Bottom-up clustering of the Gaussians of a block: of those that are near to one another, the
// two that one Gaussian stands in for best are put together, again and again.
#include <span>
#include <vector>

#include "runtime/lod/exposure.h"

namespace voyager {

// Nodes 0 to n − 1 are the block's Gaussians, the last is the root.
struct ClusterTree {
  struct Node {
    uint32_t child[4];
    uint32_t children;  // 0: a leaf
  };
  std::vector<Node> nodes;
};

// leaves: indices of at least one Gaussian of `cloud`; exposure: of each Gaussian of the cloud;
// footprint_level: of the block (node_code.h).
// Two to four children a node. Depends on nothing but its arguments; thread-safe. O(n²) time in
// distances, O(n) in errors.
ClusterTree cluster(const GaussianCloud& cloud, const std::array<double, 3>& origin,
                    std::span<const uint32_t> leaves, std::span<const ExposureCode> exposure,
                    int footprint_level = 0);

}  // namespace voyager
