#pragma once
// A .hier gives a node several Gaussians where files were merged: it draws the first. The further
// ones are kept for an export alone (docs/voy-format.md, "Further Gaussians").
#include <cstdint>
#include <vector>

namespace voyager {

struct FurtherCount {
  uint32_t node;   // breadth-first
  uint32_t count;  // at least 1
};
static_assert(sizeof(FurtherCount) == 8);

struct FurtherGaussians {
  std::vector<FurtherCount> nodes;  // ascending
  // kHierFloats (hier_format.h) of each Gaussian, as the file has them, node by node.
  std::vector<float> words;
};

}  // namespace voyager
