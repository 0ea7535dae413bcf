// The limits of a frame's tiles. Of the first pass: from the depths at which the tiles of the frame
// before were full, as its camera saw them, with some around and behind for what has moved. Of the
// second: all of those tiles that the first did not fill, and nothing of the others.
//
// No bit depends on a limit: a tile's list is cut off behind one, in its order, and a part of the
// tile whose pixels have all ended reads no further. Where they have not, the tile is drawn again.
#include "cuda/device/launch.cuh"
#include "cuda/splat/occlusion.cuh"
#include "cuda/splat/occlusion.h"
#include "cuda/splat/splat_launch.h"

namespace voyager::cuda {
namespace {

constexpr int kSquare =
    kLimitSide * kLimitSide;  // tiles of a thread block, a side: a cell of level 2
constexpr unsigned kThreads = kSquare * kSquare;

// In tiles, so that at most 8 × 8 are read for one. Where more may have come into view, all is
// drawn.
constexpr float kFarthest = 3.0f;

struct EyeTiles {
  const uint32_t* ends;
  TileGrid grid;

  __device__ uint32_t at(int32_t column, int32_t row) const {
    const uint32_t end = ends[row * grid.columns + column];
    return end == kDrawNothing ? kDrawAll : end;  // a second pass left it out: it has no list
  }
};

// The deepest end of the tiles that may now be seen in this one.
__device__ uint32_t limit_of(const EyeTiles& before, const EyeMotion& motion, int32_t column,
                             int32_t row) {
  const float* h = motion.to_before;
  const float u = static_cast<float>(column) + 0.5f, v = static_cast<float>(row) + 0.5f;
  const float w = h[6] * u + h[7] * v + h[8];
  if (!(w > 0.0f)) return kDrawAll;
  const float x = (h[0] * u + h[1] * v + h[2]) / w, y = (h[3] * u + h[4] * v + h[5]) / w;
  const auto columns = static_cast<float>(before.grid.columns);
  const auto rows = static_cast<float>(before.grid.rows);
  if (!(x >= 0.0f && x < columns && y >= 0.0f && y < rows)) return kDrawAll;
  const uint32_t own = before.at(static_cast<int32_t>(x), static_cast<int32_t>(y));
  if (own == kDrawAll) return kDrawAll;
  const float z = fmaxf(bits_float(own), 1e-3f);  // metres: parallax stays finite
  const float around = motion.around + motion.parallax / z;
  if (!(around <= kFarthest)) return kDrawAll;
  const auto first = [](float at) { return static_cast<int32_t>(fmaxf(floorf(at), 0.0f)); };
  const auto last = [](float at, float count) {
    return static_cast<int32_t>(fminf(floorf(at), count - 1.0f));
  };
  uint32_t deepest = 0;
  for (int32_t r = first(y - around); r <= last(y + around, rows); ++r)
    for (int32_t c = first(x - around); c <= last(x + around, columns); ++c)
      deepest = max(deepest, before.at(c, r));
  if (deepest == kDrawAll) return kDrawAll;
  // Too deep a limit draws a little more, too near a one takes a second pass.
  constexpr float kBehind = 1.05f;
  return float_bits(bits_float(deepest) / w * kBehind + motion.moved);
}

// A block's part of an eye's tiles, and this thread's tile.
struct Square {
  uint32_t eye;
  int32_t column, row;  // of squares
  int32_t tile_column, tile_row;
  bool inside;

  __device__ explicit Square(const FrameTiles& frame) {
    uint32_t index = blockIdx.x;
    eye = 0;
    for (;; ++eye) {
      const auto all = static_cast<uint32_t>(limit_side(frame.grids[eye].columns, 2) *
                                             limit_side(frame.grids[eye].rows, 2));
      if (index < all || eye + 1 == frame.eyes) break;
      index -= all;
    }
    const TileGrid& grid = frame.grids[eye];
    const int32_t columns = limit_side(grid.columns, 2);
    row = static_cast<int32_t>(index) / columns, column = static_cast<int32_t>(index) % columns;
    tile_column = column * kSquare + static_cast<int32_t>(threadIdx.x) % kSquare;
    tile_row = row * kSquare + static_cast<int32_t>(threadIdx.x) / kSquare;
    inside = tile_column < grid.columns && tile_row < grid.rows;
  }
};

// Writes a tile's limit, and those of the cells that it is in.
__device__ void put_limit(const FrameTiles& frame, const TileLimits& limits, uint32_t* bits,
                          const Square& at, uint32_t limit) {
  __shared__ uint32_t cells[kSquare], whole;
  if (threadIdx.x < kSquare) cells[threadIdx.x] = 0;
  if (threadIdx.x == 0) whole = 0;
  __syncthreads();
  const TileGrid& grid = frame.grids[at.eye];
  const uint32_t own =
      threadIdx.x / kSquare / kLimitSide * kLimitSide + threadIdx.x % kSquare / kLimitSide;
  if (at.inside) {
    bits[limits.first[0][at.eye] + at.tile_row * grid.columns + at.tile_column] = limit;
    atomicMax(cells + own, limit);
  }
  __syncthreads();
  if (threadIdx.x < kSquare) {
    const int32_t columns = limit_side(grid.columns, 1), rows = limit_side(grid.rows, 1);
    const int32_t column = at.column * kLimitSide + static_cast<int32_t>(threadIdx.x) % kLimitSide;
    const int32_t row = at.row * kLimitSide + static_cast<int32_t>(threadIdx.x) / kLimitSide;
    if (column < columns && row < rows)
      bits[limits.first[1][at.eye] + row * columns + column] = cells[threadIdx.x];
    atomicMax(&whole, cells[threadIdx.x]);
  }
  __syncthreads();
  if (threadIdx.x == 0)
    bits[limits.first[2][at.eye] + at.row * limit_side(grid.columns, 2) + at.column] = whole;
}

__global__ void __launch_bounds__(kThreads) occlusion_guess(OcclusionFrame f) {
  const Square at(f.tiles);
  uint32_t limit = kDrawAll;
  if (at.inside)
    limit = limit_of({f.ends + f.tiles.first[at.eye], f.tiles.grids[at.eye]}, f.motion[at.eye],
                     at.tile_column, at.tile_row);
  put_limit(f.tiles, f.limits, f.bits, at, limit);
}

// first: of the pass that left tiles open, whose ends are known.
__global__ void __launch_bounds__(kThreads)
    occlusion_rest(OcclusionFrame f, const uint32_t* first, const uint32_t* open_parts,
                   OpenTiles* tiles) {
  if (*open_parts == 0) return;
  const Square at(f.tiles);
  uint32_t limit = kDrawNothing;
  if (at.inside) {
    const uint32_t tile =
        f.tiles.first[at.eye] + at.tile_row * f.tiles.grids[at.eye].columns + at.tile_column;
    const bool open = f.ends[tile] == kDrawAll && first[tile] != kDrawAll;
    if (open) {
      limit = kDrawAll, f.ends[tile] = 0;
      const uint32_t place = atomicAdd(&tiles->count, 1u);
      if (place < kFewOpen) tiles->tiles[place] = tile;
    }
  }
  put_limit(f.tiles, f.limits, f.bits, at, limit);
}

unsigned squares(const FrameTiles& tiles) {
  unsigned all = 0;
  for (uint32_t eye = 0; eye < tiles.eyes; ++eye)
    all += static_cast<unsigned>(limit_side(tiles.grids[eye].columns, 2) *
                                 limit_side(tiles.grids[eye].rows, 2));
  return all;
}

}  // namespace

void launch_occlusion_guess(const OcclusionFrame& f, cudaStream_t stream) {
  launch_kernel("occlusion_guess", occlusion_guess, {squares(f.tiles), kThreads, stream}, f);
}

void launch_occlusion_rest(const OcclusionFrame& f, const uint32_t* first, const SplatView& splats,
                           cudaStream_t stream) {
  launch_kernel("occlusion_rest", occlusion_rest, {squares(f.tiles), kThreads, stream}, f, first,
                splats.open_parts, &splats.counters->open);
}

}  // namespace voyager::cuda
