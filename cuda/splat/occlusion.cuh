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

// Of cells of that many pixels a side, in a row or column of the image: those of [low, high].
__device__ inline TileRange limit_cells(float low, float high, int side, int32_t count) {
  const float last = static_cast<float>(count);
  const float scale = 1.0f / static_cast<float>(side);
  const float first = fminf(fmaxf(floorf(low * scale), 0.0f), last);
  const float end = fminf(fmaxf(floorf(high * scale) + 1.0f, 0.0f), last);
  return {static_cast<int32_t>(first), static_cast<int32_t>(end)};
}

// By the finest level that tells it in few cells; what is larger than those is not hidden.
__device__ inline bool hidden(const SplatView& splats, uint32_t eye, const ImageBounds& image,
                              float depth_scale) {
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
__device__ inline bool hidden_in_all(const SplatView& splats, const ProjectParams* params,
                                     const MeanBounds& bounds) {
  if (splats.limits.bits == nullptr) return false;
  for (uint32_t eye = 0; eye < splats.frame.eyes; ++eye) {
    ImageBounds image;
    if (!image_bounds(params[eye], bounds, image) ||
        !hidden(splats, eye, image, params[eye].depth_scale))
      return false;
  }
  return true;
}

}  // namespace voyager::cuda
