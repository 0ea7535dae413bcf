#pragma once
// How deep the tiles of a frame are drawn: behind what covered a tile in the frame before there is
// most often nothing to be seen. That is a guess, and no more: a tile that it does not fill is
// drawn once more, whole (occlusion.cu).
#include <cstdint>

#include "runtime/frame/backend.h"
#include "runtime/math/float_bits.h"

namespace voyager::cuda {

// Bits of a depth z > 0, which ascend as z does.
inline constexpr uint32_t kDrawNothing = 0, kDrawAll = 0xffffffffu;

// The greatest limits of 4x4 and of 16x16 tiles, too, so that few of them tell for a large splat.
inline constexpr int kLimitLevels = 3;
inline constexpr int kLimitSide = 4;  // cells of a level that are one of the next, a side

// Cells in a row or column of so many tiles.
VOYAGER_HD int32_t limit_side(int32_t tiles, int level) {
  static_assert(kLimitSide == 4);
  const int shift = 2 * level;
  return (tiles + (1 << shift) - 1) >> shift;
}

struct TileLimits {
  const uint32_t* bits =
      nullptr;  // of the frame's tiles, then the coarser levels; null: all kDrawAll
  uint32_t first[kLimitLevels][kMaxEyes];
};

// The tiles of a second pass. If there are at most so many, the kernels behind occlusion_rest look
// at these alone. Cleared with the counters, before each time that a frame is drawn.
inline constexpr uint32_t kFewOpen = 32;
struct OpenTiles {
  uint32_t count;            // may be more than are listed; 0 of a first pass
  uint32_t tiles[kFewOpen];  // in no order
  uint32_t taken[kFewOpen];  // keys written to each list so far

  VOYAGER_HD bool few() const { return count != 0 && count <= kFewOpen; }
};

}  // namespace voyager::cuda
