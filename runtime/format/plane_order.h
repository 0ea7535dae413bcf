#pragma once
// The order of values in the planes of a compact chunk: those that other values of the chunk tell
// come last, as differences that are mostly 0, each after those that tell it.
#include <cstdint>
#include <span>
#include <vector>

#include "runtime/format/families.h"

namespace voyager {

struct PlaneOrder {
  std::vector<uint32_t> item;
  size_t plain = 0;  // items; the others are told
};

// Of records: a box is told by those of the node's children.
PlaneOrder box_order(const Families& families);

// Of records: the extent of a leaf, or of a double (docs/lod-tree.md), is told by its parent's.
PlaneOrder extent_order(const Families& families, const ChunkCounts& counts);

// Of owned nodes, whose record is record[node]: the Gaussian of a double is its child's.
struct GaussianOrder : PlaneOrder {
  std::vector<uint32_t> child;  // of each item that is told
};
GaussianOrder gaussian_order(const Families& families, const ChunkCounts& counts,
                             std::span<const uint32_t> record);

}  // namespace voyager
