#pragma once
// The byte that each node of a tree has: an axis code (axes.h) and a footprint level (METHOD §12).
// Level L has the scene's largest native footprint v times 2^-L: the side of its pixel is shorter
// by √2 at each level. A code is below 24 · levels; where a scene has one level it is an axis code.
#include <cstdint>

#include "runtime/math/axes.h"

namespace voyager {

inline constexpr int kFootprintLevels = 10;  // as many as a byte has room for

VOYAGER_HD uint8_t node_code(int axis_code, int footprint_level) {
  return static_cast<uint8_t>(axis_code + kAxisCodes * footprint_level);
}
VOYAGER_HD int axis_code_of(int node_code) {
  return node_code % kAxisCodes;
}
VOYAGER_HD int footprint_level_of(int node_code) {
  return node_code / kAxisCodes;
}

// Exact, but for a footprint that becomes subnormal.
template <class T>
VOYAGER_HD T footprint_at(T largest, int level) {
  return largest / T(1 << level);
}

}  // namespace voyager
