#pragma once
// Means as a compact scene has them in memory: 21 bits an axis, on a grid of the chunk's
// (docs/voy-format.md). Every point of a grid is a binary32 number, and each operation that
// restores one is exact, so that host and device have the same bits.
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "runtime/math/host_device.h"
#include "runtime/math/vec.h"

namespace voyager {

struct MeanCode {
  uint32_t low, high;  // x from bit 0 of the two together, y from bit 21, z from bit 42
};

// The points origin + q * step, q from 0 to kMostMeanSteps an axis. Aligned so that a device reads
// it at once.
struct alignas(16) MeanGrid {
  float origin[3];
  float step;  // a power of two; origins are multiples of it
};

inline constexpr int kMeanBits = 21;
inline constexpr uint32_t kMostMeanSteps = (1u << kMeanBits) - 1;
inline constexpr int kLeastMeanExponent = -126, kMostMeanExponent = 127;  // of a step

VOYAGER_HD Vec3f restored_mean(const MeanCode& code, const MeanGrid& grid) {
  const uint32_t x = code.low & kMostMeanSteps;
  const uint32_t y = (code.low >> kMeanBits | code.high << (32 - kMeanBits)) & kMostMeanSteps;
  const uint32_t z = code.high >> (2 * kMeanBits - 32) & kMostMeanSteps;
  return {grid.origin[0] + static_cast<float>(x) * grid.step,
          grid.origin[1] + static_cast<float>(y) * grid.step,
          grid.origin[2] + static_cast<float>(z) * grid.step};
}

// The whole number nearest to |x| <= 2^51, of two the even one.
inline double nearest_whole(double x) {
  constexpr double kWhole = 0x1.8p52;  // of so large a number the last bit is worth one
  return x + kWhole - kWhole;
}

// The finest grid that holds all from least to greatest, finite: binary32 must have its points
// (2^24 steps from 0), and an axis at most kMostMeanSteps. A mean is off by at most half a step an
// axis. Means that were restored have a grid that restores them again.
inline MeanGrid mean_grid(const Vec3f& least, const Vec3f& greatest) {
  double farthest = 0, longest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    farthest =
        std::max({farthest, std::fabs(double{least[axis]}), std::fabs(double{greatest[axis]})});
    longest = std::max(longest, double{greatest[axis]} - double{least[axis]});
  }
  const double finest = std::max(farthest * 0x1p-24, longest / kMostMeanSteps);
  int exponent = kLeastMeanExponent;
  if (finest > std::ldexp(1.0, exponent)) exponent = std::max(exponent, std::ilogb(finest));
  for (;; ++exponent) {
    const double step = std::ldexp(1.0, exponent);
    bool fits = farthest <= step * 0x1p24;
    MeanGrid grid{{}, static_cast<float>(step)};
    for (int axis = 0; axis < 3; ++axis) {
      const double first = nearest_whole(least[axis] / step);
      fits = fits && nearest_whole(greatest[axis] / step) - first <= kMostMeanSteps;
      grid.origin[axis] = static_cast<float>(first * step);
    }
    if (fits || exponent >= kMostMeanExponent) return grid;
  }
}

// The point of the grid nearest to a mean that it holds.
inline MeanCode mean_code(const Vec3f& mean, const MeanGrid& grid) {
  uint64_t code = 0;
  const double steps_a_metre = 1.0 / grid.step;  // exact
  for (int axis = 0; axis < 3; ++axis) {
    const double q = nearest_whole(mean[axis] * steps_a_metre) - grid.origin[axis] * steps_a_metre;
    code |= static_cast<uint64_t>(q) << (axis * kMeanBits);
  }
  return {static_cast<uint32_t>(code), static_cast<uint32_t>(code >> 32)};
}

}  // namespace voyager
