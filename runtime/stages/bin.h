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

// The tiles, of `count` in a row, with a pixel centre between `low` and `high`.
VOYAGER_HD TileRange tiles_within(float low, float high, int32_t count) {
  const float last_pixel = static_cast<float>(count * kTile - 1);
  low -= 0.5f;
  high -= 0.5f;
  if (!(high >= 0.0f) || !(low <= last_pixel)) return {0, 0};
  // Cut to the image first: casts then round as floor does, without its cost.
  int32_t first = low > 0.0f ? static_cast<int32_t>(low) : 0;
  first += static_cast<float>(first) < low;
  const int32_t last = static_cast<int32_t>(high < last_pixel ? high : last_pixel);
  return last < first ? TileRange{0, 0} : TileRange{first / kTile, last / kTile + 1};
}

namespace detail {

// More than the rounding of centre ± reach, and of the strips' arithmetic.
VOYAGER_HD float edge_slack(float centre, float reach) {
  return 1e-5f + 2e-7f * std::fabs(centre) + 4e-6f * reach;
}
VOYAGER_HD TileRange tiles_around(float centre, float low, float high, float reach, int32_t count) {
  const float slack = edge_slack(centre, reach);
  return tiles_within(centre - low - slack, centre + high + slack, count);
}

}  // namespace detail

VOYAGER_HD TileRange box_columns(const Splat& s, const TileGrid& grid) {
  return detail::tiles_around(s.x, s.half_width, s.half_width, s.half_width, grid.columns);
}
VOYAGER_HD TileRange box_rows(const Splat& s, const TileGrid& grid) {
  return detail::tiles_around(s.y, s.half_height, s.half_height, s.half_height, grid.rows);
}

namespace detail {
VOYAGER_HD float right_edge(const SupportEllipse& e, float dy) {
  // 1 - f² is wrong by up to 4ε, which its root magnifies near the tips.
  const float f = dy / e.reach_y, inside = (1.0f + 1e-6f) - f * f;
  return e.along * dy + e.across * std::sqrt(inside > 0.0f ? inside : 0.0f);
}
VOYAGER_HD float clamp(float x, float low, float high) {
  return x < low ? low : (x > high ? high : x);
}
}  // namespace detail

// The columns that the ellipse reaches in the row of tiles.
VOYAGER_HD TileRange strip_columns(const SupportEllipse& e, int32_t row, const TileGrid& grid) {
  // Differences of exact numbers: their errors are relative.
  float low = (static_cast<float>(row * kTile) + 0.5f) - e.y;
  float high = (static_cast<float>(row * kTile + kTile) - 0.5f) - e.y;
  if (low > e.reach_y || high < -e.reach_y) return {0, 0};
  low = low < -e.reach_y ? -e.reach_y : low;
  high = high > e.reach_y ? e.reach_y : high;
  // The ellipse is its own mirror image through the centre.
  const float right = detail::right_edge(e, detail::clamp(e.top, low, high));
  const float left = detail::right_edge(e, detail::clamp(e.top, -high, -low));
  return detail::tiles_around(e.x, left, right, e.reach_x, grid.columns);
}

}  // namespace voyager
