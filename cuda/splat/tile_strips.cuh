#pragma once
// A splat's tiles, a row of tiles at a time. All splats of a warp are cut up by all of its
// lanes together: one splat may have one strip, another a hundred.
#include "cuda/device/warp.cuh"
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

// What a strip is made of, in shared memory: three words of 16 bytes, of which eight lanes write
// theirs at once without colliding.
struct alignas(16) StripSource {
  SupportEllipse ellipse;
  int32_t row_less_before;  // the first strip's row, less the strips of the lanes below
  TileRange columns;
  uint32_t depth, slot;
};
static_assert(sizeof(StripSource) == 48);

// Of a warp's splats that have strips, in the order of lanes.
struct WarpExtents {
  StripSource source[32];
};

// Writes the strips of a whole warp's splats in the image of one eye, one splat a lane. boxes:
// whole rows of each box, in place of what the ellipse touches.
template <int kEyes>
__device__ void write_strips(WarpExtents& shared, const TileExtent& own, const SplatView& splats,
                             int eye, float depth, uint32_t slot, bool boxes) {
  const uint32_t lane = lane_in_warp();
  const WarpShares shares(own.strips());
  const uint32_t strips = shares.total();
  if (strips == 0) return;
  const bool some = own.strips() != 0;
  const uint32_t before_own = shares.before(), at_most_own = (2u << lane) - 1u;
  const TileGrid& grid = splats.frame.grids[eye];
  constexpr uint32_t kRegions = kStripRegions / kEyes;
  const uint32_t region = eye * kRegions + blockIdx.x % kRegions;
  const uint32_t room = splats.strip_room / kStripRegions;
  uint32_t first = 0;
  if (lane == 0) first = atomicAdd(strip_count(splats, region), strips);
  first = __shfl_sync(kAllLanes, first, 0);
  const unsigned with_some = __ballot_sync(kAllLanes, some);
  if (some)
    shared.source[__popc(with_some & at_most_own) - 1] = {
        own.ellipse, own.rows.begin - static_cast<int32_t>(before_own), own.columns,
        float_bits(depth), slot};
  __syncwarp();
  int begun = 0;  // splats whose first strip is below base
  for (uint32_t base = 0; base < strips; base += 32) {
    const uint32_t strip = base + lane, own_at = before_own - base;
    const unsigned starts = __reduce_or_sync(kAllLanes, some && own_at < 32 ? 1u << own_at : 0);
    const int owner = begun + __popc(starts & at_most_own) - 1;
    begun += __popc(starts);
    if (strip >= strips) continue;
    const StripSource& source = shared.source[owner];
    const int32_t row = source.row_less_before + static_cast<int32_t>(strip);
    const TileRange columns = boxes ? source.columns : strip_columns(source.ellipse, row, grid);
    if (first + strip < room)
      splats.strips[region * room + first + strip] = {
          source.slot, source.depth,
          splats.frame.first[eye] + static_cast<uint32_t>(row * grid.columns + columns.begin),
          static_cast<uint32_t>(columns.end - columns.begin)};
  }
  __syncwarp();
}

}  // namespace voyager::cuda
