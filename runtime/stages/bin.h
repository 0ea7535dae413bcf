#pragma once
// METHOD §7b as a stage: the tiles that a splat can touch.
#include <cmath>
#include <cstdint>

#include "runtime/stages/project.h"

namespace voyager {

inline constexpr int kTile = 16;  // pixels a side; a row is one AVX-512 register of binary32

struct TileGrid {
  int32_t columns, rows;
};
VOYAGER_HD TileGrid tile_grid(uint32_t width, uint32_t height) {
  return {static_cast<int32_t>((width + kTile - 1) / kTile),
          static_cast<int32_t>((height + kTile - 1) / kTile)};
}

// Half-open.
struct TileRange {
  int32_t begin, end;
};

// What follows is exactly the same wherever it is compiled (runtime/math/exact.h).
namespace detail {

// The tiles, of `count` in a row, with a pixel centre between centre - before and
// centre + after, which carry the rounding of an ellipse of that reach.
VOYAGER_HD TileRange tiles_around(Rounded centre, Rounded before, Rounded after, Rounded reach,
                                  int32_t count) {
  const Rounded slack =
      Rounded(0.5e-5f) + Rounded(2e-7f) * std::fabs(centre.value) + Rounded(4e-6f) * reach;
  const float last_pixel = static_cast<float>(count * kTile - 1);
  const float low = ((centre - before) - slack - 0.5f).value;
  const float high = ((centre + after) + slack - 0.5f).value;
  if (!(high >= 0.0f) || !(low <= last_pixel)) return {0, 0};
  // Cut to the image first: casts then round as floor does, without its cost.
  int32_t first = low > 0.0f ? static_cast<int32_t>(low) : 0;
  first += static_cast<float>(first) < low;
  const int32_t last = static_cast<int32_t>(high < last_pixel ? high : last_pixel);
  if (last < first) return {0, 0};
  // Neither is negative: a division of such numbers is a shift.
  const auto tile = [](int32_t pixel) {
    return static_cast<int32_t>(static_cast<uint32_t>(pixel) / uint32_t{kTile});
  };
  return {tile(first), tile(last) + 1};
}

VOYAGER_HD Rounded right_edge(const SupportEllipse& e, const Divisor& reach_y, Rounded dy) {
  // 1 - f² is wrong by up to 4ε, which its root magnifies near the tips.
  const Rounded f = reach_y.quotient(dy), inside = Rounded(1.0f + 1e-6f) - f * f;
  return Rounded(e.along) * dy + Rounded(e.across) * sqrt(inside > 0.0f ? inside : 0.0f);
}
VOYAGER_HD Rounded clamp(Rounded x, Rounded low, Rounded high) {
  return x < low ? low : (x > high ? high : x);
}

}  // namespace detail

// The tiles in a row or column of `count` that [centre - reach, centre + reach] touches.
VOYAGER_HD TileRange box_tiles(float centre, float reach, int32_t count) {
  return detail::tiles_around(centre, reach, reach, reach, count);
}

// The columns that the ellipse reaches in a row of tiles.
VOYAGER_HD TileRange strip_columns(const SupportEllipse& e, int32_t row, const TileGrid& grid) {
  // Differences of exact numbers: their errors are relative.
  Rounded low = Rounded(static_cast<float>(row * kTile) + 0.5f) - e.y;
  Rounded high = Rounded(static_cast<float>(row * kTile + kTile) - 0.5f) - e.y;
  if (low > e.reach_y || high < -e.reach_y) return {0, 0};
  low = low < -e.reach_y ? -e.reach_y : low;
  high = high > e.reach_y ? e.reach_y : high;
  // The ellipse is its own mirror image through the centre.
  const Divisor reach_y(e.reach_y);
  const Rounded right = detail::right_edge(e, reach_y, detail::clamp(e.top, low, high));
  const Rounded left = detail::right_edge(e, reach_y, detail::clamp(e.top, -high, -low));
  return detail::tiles_around(e.x, left, right, e.reach_x, grid.columns);
}

}  // namespace voyager
