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
VOYAGER_HD TileRange tiles_within(double low, double high, int32_t count) {
  const double last_pixel = static_cast<double>(count) * kTile - 1.0;
  low -= 0.5;
  high -= 0.5;
  if (!(high >= 0.0) || !(low <= last_pixel)) return {0, 0};
  // Cut to the image first: casts then round as floor does, without its cost.
  int32_t first = low > 0.0 ? static_cast<int32_t>(low) : 0;
  first += static_cast<double>(first) < low;
  const int32_t last = static_cast<int32_t>(high < last_pixel ? high : last_pixel);
  return last < first ? TileRange{0, 0} : TileRange{first / kTile, last / kTile + 1};
}

VOYAGER_HD TileRange box_columns(const Splat& s, const TileGrid& grid) {
  const double x = static_cast<double>(s.x), reach = static_cast<double>(s.half_width);
  return tiles_within(x - reach, x + reach, grid.columns);
}
VOYAGER_HD TileRange box_rows(const Splat& s, const TileGrid& grid) {
  const double y = static_cast<double>(s.y), reach = static_cast<double>(s.half_height);
  return tiles_within(y - reach, y + reach, grid.rows);
}

namespace detail {
VOYAGER_HD double right_edge(const SupportEllipse& e, double dy) {
  const double f = dy / e.reach_y, inside = 1.0 - f * f;
  return e.along * dy + e.across * std::sqrt(inside > 0.0 ? inside : 0.0);
}
VOYAGER_HD double clamp(double x, double low, double high) {
  return x < low ? low : (x > high ? high : x);
}
}  // namespace detail

// The columns that the ellipse reaches between two pixel rows (centres, inclusive).
VOYAGER_HD TileRange strip_columns(const SupportEllipse& e, double y_first, double y_last,
                                   const TileGrid& grid) {
  double low = y_first - e.y, high = y_last - e.y;
  if (low > e.reach_y || high < -e.reach_y) return {0, 0};
  low = low < -e.reach_y ? -e.reach_y : low;
  high = high > e.reach_y ? e.reach_y : high;
  // The ellipse is its own mirror image through the centre.
  const double right = detail::right_edge(e, detail::clamp(e.top, low, high));
  const double left = detail::right_edge(e, detail::clamp(e.top, -high, -low));
  const double slack = 1e-9 * e.reach_x + 1e-9;  // of this arithmetic itself
  return tiles_within(e.x - left - slack, e.x + right + slack, grid.columns);
}

}  // namespace voyager
