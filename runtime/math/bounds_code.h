#pragma once
// The box and the extent of a node with children as every search reads them
// (docs/lod-selection.md): 12 bytes, rounded so that no node gets smaller than its file says.
//
// A box is a corner on a grid and a number of steps across. Its step is the least power of two for
// which that fits, whatever the steps of other nodes are. So, on every machine alike:
//   - what is decoded is exact in binary32, and covers what was encoded;
//   - boxes that nest and extents that do not grow downwards stay so: if A lies in B, A fits every
//     grid that B fits, and the points of a coarser grid are on the finer one;
//   - encoding what was decoded gives the same code.
// A side moves by less than a step. That is less than a 30th of the longest side, or 1/65,535 of
// the largest coordinate, or 2^-126, whichever is most. An extent grows by less than a 256th, or
// 2^-134 where that is more; one beyond 255.5 · 2^120 becomes +inf.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "runtime/math/exact.h"
#include "runtime/math/float_bits.h"
#include "runtime/math/screen_size.h"

namespace voyager {

// From the lowest bit: of each axis the least corner in steps (18 bits, two's complement) and the
// steps across (6 bits); above them the step's exponent in axis 0, as binary32 has it, and the
// upper and the lower half of the extent's upper bits in axes 1 and 2.
struct BoundsCode {
  uint32_t axis[3];

  bool operator==(const BoundsCode&) const = default;
};

inline constexpr int kCornerBits = 18, kStepBits = 6;
inline constexpr int32_t kMostCorner = (1 << (kCornerBits - 1)) - 1,
                         kMostSteps = (1 << kStepBits) - 1;
inline constexpr int kLeastGridExponent = -126;
inline constexpr int kExtentShift = 15;  // bits of an extent's binary32 that are left out

// |steps| < 2^22, as a float: without a conversion, which a device has few units for.
VOYAGER_HD float steps_as_float(int32_t steps) {
  return bits_float(0x4b400000u + static_cast<uint32_t>(steps)) - 12582912.0f;
}

VOYAGER_HD NodeBounds decode_bounds(const BoundsCode& code) {
  const float step = bits_float(code.axis[0] >> 24 << 23);
  const uint32_t extent = code.axis[1] >> 24 << 8 | code.axis[2] >> 24;
  NodeBounds b;
  b.extent = bits_float(extent << kExtentShift);
  for (int axis = 0; axis < 3; ++axis) {
    const uint32_t word = code.axis[axis];
    const int32_t corner = static_cast<int32_t>(word << (32 - kCornerBits)) >> (32 - kCornerBits);
    const auto across = static_cast<int32_t>(word >> kCornerBits & kMostSteps);
    b.box_min[axis] = multiply_rn(steps_as_float(corner), step);
    b.box_max[axis] = multiply_rn(steps_as_float(corner + across), step);
  }
  return b;
}

// Whether a box fits a grid of 2^exponent, and how; exact. Both corners are bounded: else one that
// lies in another might not fit a grid that this one fits.
inline bool fits_grid(const NodeBounds& bounds, int exponent, int32_t* corner, int32_t* across) {
  const double steps_a_metre = std::ldexp(1.0, -exponent);
  for (int axis = 0; axis < 3; ++axis) {
    const double from = steps_a_metre * double{bounds.box_min[axis]};
    const double to = steps_a_metre * double{bounds.box_max[axis]};
    if (!(from >= -kMostCorner - 1 && to <= kMostCorner)) return false;
    const auto least = static_cast<int32_t>(from), most = static_cast<int32_t>(to);
    corner[axis] = least - (least > from);
    across[axis] = most + (most < to) - corner[axis];
    if (across[axis] > kMostSteps) return false;
  }
  return true;
}

// No box fits a grid of a smaller one.
inline int least_grid_exponent(const NodeBounds& bounds) {
  double longest = 0, farthest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double low = bounds.box_min[axis], high = bounds.box_max[axis];
    longest = std::max(longest, high - low);
    farthest = std::max({farthest, -low, high});
  }
  const auto log2 = [](double x) { return x > 0 ? std::ilogb(x) : kLeastGridExponent; };
  return std::max(
      {kLeastGridExponent, log2(longest) - kStepBits + 1, log2(farthest) - kCornerBits + 1});
}

// The box is finite, ordered and below 2^126 in magnitude; the extent is not negative, may be +inf.
inline BoundsCode encode_bounds(const NodeBounds& bounds) {
  int32_t corner[3], across[3];
  int exponent = least_grid_exponent(bounds);
  while (!fits_grid(bounds, exponent, corner, across)) ++exponent;
  constexpr uint32_t kUp = (1u << kExtentShift) - 1;
  const uint32_t extent = (float_bits(bounds.extent + 0.0f) + kUp) >> kExtentShift;  // no -0
  const uint32_t top[] = {static_cast<uint32_t>(exponent + 127), extent >> 8, extent & 0xff};
  BoundsCode code{};
  for (int axis = 0; axis < 3; ++axis)
    code.axis[axis] = (static_cast<uint32_t>(corner[axis]) & ((1u << kCornerBits) - 1)) |
                      static_cast<uint32_t>(across[axis]) << kCornerBits | top[axis] << 24;
  return code;
}

// What a search reads of those bounds.
inline NodeBounds round_bounds(const NodeBounds& bounds) {
  return decode_bounds(encode_bounds(bounds));
}

}  // namespace voyager
