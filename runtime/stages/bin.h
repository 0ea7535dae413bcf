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

// The tiles [begin, end) of `count` whose pixel centres lie within `reach` of `centre`.
VOYAGER_HD TileRange tiles_within(double centre, double reach_low, double reach_high,
                                  int32_t count) {
  const double first = std::ceil(centre - reach_low - 0.5),
               last = std::floor(centre + reach_high - 0.5);
  if (!(last >= 0.0) || !(first < static_cast<double>(count) * kTile) || last < first)
    return {0, 0};
  const int32_t begin = first <= 0.0 ? 0 : static_cast<int32_t>(first) / kTile;
  const double end = std::floor(last / kTile) + 1.0;
  return {begin, end > count ? count : static_cast<int32_t>(end)};
}

VOYAGER_HD TileRange box_columns(const Splat& s, const TileGrid& grid) {
  const double reach = static_cast<double>(s.half_width);
  return tiles_within(static_cast<double>(s.x), reach, reach, grid.columns);
}
VOYAGER_HD TileRange box_rows(const Splat& s, const TileGrid& grid) {
  const double reach = static_cast<double>(s.half_height);
  return tiles_within(static_cast<double>(s.y), reach, reach, grid.rows);
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
  return tiles_within(e.x, left + slack, right + slack, grid.columns);
}

}  // namespace voyager
