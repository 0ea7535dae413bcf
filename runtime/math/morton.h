#pragma once
// The Morton curve: neighbours on it are mostly neighbours in space.
#include <cstdint>

#include "runtime/math/host_device.h"

namespace voyager {

inline constexpr int kMortonBits = 21;  // an axis

// Two zeros after each of the lowest 21 bits.
VOYAGER_HD constexpr uint64_t spread_bits(uint64_t x) {
  x &= 0x1fffff;
  x = (x | x << 32) & 0x1f00000000ffff;
  x = (x | x << 16) & 0x1f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

// Place on the curve of a cell, of which each coordinate is below 2^21.
VOYAGER_HD constexpr uint64_t morton_code(uint32_t x, uint32_t y, uint32_t z) {
  return spread_bits(x) | spread_bits(y) << 1 | spread_bits(z) << 2;
}

}  // namespace voyager
