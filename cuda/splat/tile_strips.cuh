#pragma once
// A splat's tiles, a row of tiles at a time. All splats of a warp are cut up by all of its
// lanes together: one splat may have one strip, another a hundred.
#include "cuda/device/warp_shares.cuh"
#include "cuda/splat/splats.h"

namespace voyager::cuda {

// Where a splat's support lies among the tiles.
struct TileExtent {
  SupportEllipse ellipse;
  TileRange rows, columns;  // of its box; no rows where there is no splat

  __device__ uint32_t strips() const { return static_cast<uint32_t>(rows.end - rows.begin); }
  __device__ uint32_t boxed() const {
    return strips() * static_cast<uint32_t>(columns.end - columns.begin);
  }
};

__device__ inline TileExtent tile_extent(const SupportEllipse& ellipse, const TileGrid& grid) {
  TileExtent extent{ellipse, box_tiles(ellipse.y, ellipse.reach_y, grid.rows),
                    box_tiles(ellipse.x, ellipse.reach_x, grid.columns)};
  if (extent.columns.end == extent.columns.begin) extent.rows = {0, 0};
  return extent;
}

// The splats of a warp, in shared memory. Odd in words, so that lanes do not collide.
struct WarpExtents {
  TileExtent extent[32];
  uint32_t depth[32], slot[32];

  __device__ void put(uint32_t lane, const TileExtent& own, float z, uint32_t at) {
    extent[lane] = own;
    depth[lane] = float_bits(z);
    slot[lane] = at;
  }
};

// Writes the strips of a whole warp's splats in the image of one eye, one splat a lane, which has
// `own` of them and has put its extent, if there are any. boxes: whole rows of each box, in place
// of what the ellipse touches.
template <int kEyes>
__device__ void write_strips(const WarpExtents& shared, uint32_t own, const SplatView& splats,
                             int eye, bool boxes) {
  constexpr unsigned kAll = 0xffffffffu;
  const uint32_t lane = threadIdx.x % 32;
  const WarpShares shares(own);
  const uint32_t strips = shares.total();
  if (strips == 0) return;
  const TileGrid& grid = splats.frame.grids[eye];
  constexpr uint32_t kRegions = kStripRegions / kEyes;
  const uint32_t region = eye * kRegions + blockIdx.x % kRegions;
  const uint32_t room = splats.strip_room / kStripRegions;
  uint32_t first = 0;
  if (lane == 0) first = atomicAdd(strip_count(splats, region), strips);
  first = __shfl_sync(kAll, first, 0);
  __syncwarp();
  for (uint32_t base = 0; base < strips; base += 32) {
    const uint32_t strip = base + lane;
    const unsigned owner = shares.owner(strip);
    const uint32_t owner_before = __shfl_sync(kAll, shares.before(), owner);
    if (strip >= strips) continue;
    const TileExtent& extent = shared.extent[owner];
    const int32_t row = extent.rows.begin + static_cast<int32_t>(strip - owner_before);
    const TileRange columns = boxes ? extent.columns : strip_columns(extent.ellipse, row, grid);
    if (first + strip < room)
      splats.strips[region * room + first + strip] = {
          shared.slot[owner], shared.depth[owner],
          splats.frame.first[eye] + static_cast<uint32_t>(row * grid.columns + columns.begin),
          static_cast<uint32_t>(columns.end - columns.begin)};
  }
  __syncwarp();
}

}  // namespace voyager::cuda
