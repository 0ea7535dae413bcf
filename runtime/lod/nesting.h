#pragma once
// Between two records of a tree (runtime/lod/tree.h), wherever they were read.
#include <array>
#include <bit>

#include "runtime/lod/tree.h"

namespace voyager {

// To the bit.
inline bool is_same(const NodeRecord& a, const NodeRecord& b) {
  using Words = std::array<uint32_t, sizeof(NodeRecord) / sizeof(uint32_t)>;
  return std::bit_cast<Words>(a) == std::bit_cast<Words>(b);
}

// The box and the extent of a child, as every search relies on it. parent: a NodeRecord, or the
// NodeBounds that searches read of it: a child inside these is inside them when it is rounded, too.
template <class Bounds = NodeRecord>
bool is_inside(const NodeRecord& child, const Bounds& parent) {
  for (int axis = 0; axis < 3; ++axis)
    if (child.box_min[axis] < parent.box_min[axis] || child.box_max[axis] > parent.box_max[axis])
      return false;
  return child.extent <= parent.extent;
}

}  // namespace voyager
