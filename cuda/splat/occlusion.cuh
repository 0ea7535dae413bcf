#pragma once
// Whether what a Gaussian or a row of them may draw lies behind the limits of its tiles.
#include "cuda/splat/splats.h"
#include "runtime/math/sort_key.h"
#include "runtime/stages/reach.h"

namespace voyager::cuda {

// A second pass has none where the first left no tile open.
__device__ inline bool has_work(const SplatView& splats) {
  return splats.open_parts == nullptr || *splats.open_parts != 0;
}

// Whether this is a second pass that has few tiles.
__device__ inline bool draws_few(const SplatView& splats) {
  return splats.open_parts != nullptr && splats.counters->open.few();
}

// Lists of the pass, which tile_order begins with.
__device__ inline uint32_t list_count(const SplatView& splats) {
  return draws_few(splats) ? splats.counters->open.count : splats.frame.count();
}

// Of cells of that many pixels a side, in a row or column of the image: those of [low, high].
__device__ inline TileRange limit_cells(float low, float high, int side, int32_t count) {
  const float last = static_cast<float>(count);
  const float scale = 1.0f / static_cast<float>(side);
  const float first = fminf(fmaxf(floorf(low * scale), 0.0f), last);
  const float end = fminf(fmaxf(floorf(high * scale) + 1.0f, 0.0f), last);
  return {static_cast<int32_t>(first), static_cast<int32_t>(end)};
}

// With few open tiles: true if the bounds reach one of them.
__device__ inline bool reaches_open(const SplatView& splats, uint32_t eye,
                                    const ImageBounds& image) {
  const TileGrid& grid = splats.frame.grids[eye];
  const TileRange columns = limit_cells(image.left, image.right, kTile, grid.columns);
  const TileRange rows = limit_cells(image.top, image.bottom, kTile, grid.rows);
  const OpenTiles& open = splats.counters->open;
  for (uint32_t i = 0; i < open.count; ++i) {
    const uint32_t tile = open.tiles[i];
    if (splats.frame.eye(tile) != eye) continue;
    const auto own = static_cast<int32_t>(tile - splats.frame.first[eye]);
    const int32_t row = own / grid.columns, column = own - row * grid.columns;
    if (column >= columns.begin && column < columns.end && row >= rows.begin && row < rows.end)
      return true;
  }
  return false;
}

// By the finest level that tells it in few cells; what is larger than those is not hidden.
// kSecond: of a second pass. A first one has no registers left for draws_few().
template <bool kSecond>
__device__ bool hidden(const SplatView& splats, uint32_t eye, const ImageBounds& image,
                       float depth_scale) {
  if constexpr (kSecond)
    if (draws_few(splats)) return !reaches_open(splats, eye, image);
  constexpr int kMostCells = 3;  // a side: nine reads at most, for what is tested for each splat
  const uint32_t depth = float_bits(sort_depth(image.nearest, depth_scale));
  const TileGrid& grid = splats.frame.grids[eye];
  int side = kTile;
  for (int level = 0; level < kLimitLevels; ++level, side *= kLimitSide) {
    const int32_t of_row = limit_side(grid.columns, level);
    const TileRange columns = limit_cells(image.left, image.right, side, of_row);
    const TileRange rows = limit_cells(image.top, image.bottom, side, limit_side(grid.rows, level));
    if (columns.end - columns.begin > kMostCells || rows.end - rows.begin > kMostCells) continue;
    const uint32_t* limits = splats.limits.bits + splats.limits.first[level][eye];
    for (int32_t row = rows.begin; row < rows.end; ++row)
      for (int32_t column = columns.begin; column < columns.end; ++column)
        if (__ldg(limits + row * of_row + column) >= depth) return false;
    return true;
  }
  return false;
}

// In every eye.
template <bool kSecond>
__device__ bool hidden_in_all(const SplatView& splats, const ProjectParams* params,
                              const MeanBounds& bounds) {
  if (splats.limits.bits == nullptr) return false;
  for (uint32_t eye = 0; eye < splats.frame.eyes; ++eye) {
    ImageBounds image;
    if (!image_bounds(params[eye], bounds, image) ||
        !hidden<kSecond>(splats, eye, image, params[eye].depth_scale))
      return false;
  }
  return true;
}

}  // namespace voyager::cuda
