#pragma once
// The shape of a kd tree: how many children a node over `size` Gaussians has,
// and how many Gaussians each of them. It depends on the size alone.
#include <cstdint>

#include "runtime/lod/build.h"

namespace voyager {

// Median splits fall on multiples of this, so that every subtree of 4 and of 16
// Gaussians but the last of a scene is full. There is then at most 0.36 of a
// merged Gaussian for each input Gaussian; plain halving needs up to 0.67.
constexpr uint32_t split_unit(uint32_t size) {
  return size > kChildren * kChildren ? kChildren * kChildren : (size > kChildren ? kChildren : 1);
}

// Gaussians on the lower side of a split of `size`, which exceeds `unit`.
constexpr uint32_t lower_part(uint32_t size, uint32_t unit) {
  const uint32_t units = size / unit + (size % unit != 0);
  return unit * ((units + 1) / 2);
}

struct Parts {
  uint32_t count;
  uint32_t size[kChildren];
};

// Children of a node over size ≥ 2 Gaussians, in order along the splits.
Parts split_in_parts(uint32_t size);

// Nodes of the tree over `gaussians` Gaussians.
uint64_t count_nodes(uint32_t gaussians);

}  // namespace voyager
