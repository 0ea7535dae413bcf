#pragma once
// How many children the nodes of a compact scene have, where a ShapeCode has no room to say so.
#include <cstdint>

#include "runtime/math/host_device.h"

namespace voyager {

// From so many children on a family is large.
inline constexpr uint32_t kManyChildren = 0x7f;

struct LargeFamily {
  uint32_t parent, children;
};

// Of one that is among them. families: by parent, ascending.
VOYAGER_HD uint32_t children_of(uint32_t parent, const LargeFamily* families, uint32_t count) {
  uint32_t low = 0, high = count;
  while (high - low > 1) {
    const uint32_t middle = (low + high) / 2;
    if (families[middle].parent <= parent)
      low = middle;
    else
      high = middle;
  }
  return families[low].children;
}

}  // namespace voyager
