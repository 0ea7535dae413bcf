// The adjoint of rasterize_tiles (runtime/stages/blend_gradient.h): each tile's list front to back
// once more. A warp has a part of the tile, a lane one of its pixels; of each splat the warp adds
// its pixels' shares up before it adds them to the splat's sums.
#include "cuda/device/launch.cuh"
#include "cuda/device/warp.cuh"
#include "cuda/splat/raster_part.cuh"
#include "cuda/train/fixed_sum.cuh"
#include "runtime/stages/blend_gradient.h"

namespace voyager::cuda {
namespace {

constexpr int kTrainRows = 32 / kPartWidth;  // of a warp's part
constexpr int kWarps = kTile * kTile / 32;
constexpr unsigned kThreads = 32 * kWarps;

struct TrainSplats {
  float4 shape[32], middle[32], colour[32];
  uint32_t slot[32];
};

struct BlendParams {
  SplatView splats;
  TrainPictures pictures;
  float log_threshold;
  FixedSum* sums;
};

// Sums over a warp of eight values a lane. Every fourth lane has one, that of its number / 4.
__device__ float warp_sums(float (&v)[8], uint32_t lane) {
#pragma unroll
  for (int half = 4, offset = 16; half != 0; half /= 2, offset /= 2) {
    const bool upper = (lane & offset) != 0;
#pragma unroll
    for (int i = 0; i < half; ++i) {
      const float sent = upper ? v[i] : v[i + half];
      const float kept = upper ? v[i + half] : v[i];
      v[i] = kept + __shfl_xor_sync(kAllLanes, sent, offset);
    }
  }
  float sum = v[0];
  sum += __shfl_xor_sync(kAllLanes, sum, 2);
  sum += __shfl_xor_sync(kAllLanes, sum, 1);
  return sum;
}

__device__ PixelAdjoint<float> adjoint_at(const TrainPictures& pictures, uint32_t pixel) {
  const float4 drawn = __ldg(pictures.drawn + pixel), truth = __ldg(pictures.truth + pixel);
  const float twice = 2.0f * pictures.weight;
  return {{drawn.x, drawn.y, drawn.z},
          1.0f - drawn.w,
          {twice * (drawn.x - truth.x), twice * (drawn.y - truth.y), twice * (drawn.z - truth.z)},
          twice * kCoverageWeight * (drawn.w - truth.w)};
}

// What a pixel adds to the sums of a splat.
__device__ void add_pixel(const TrainSplats& chosen, int i, float x, float y, float log_threshold,
                          float error, PixelAdjoint<float>& pixel, bool& open, FixedSum* sums) {
  const float4 shape = chosen.shape[i], middle = chosen.middle[i], colour = chosen.colour[i];
  const float dx = x - shape.x, dy = y - shape.y;
  const float p = dx * shape.z, q = fmaf(-middle.x, dx, dy) * shape.w;
  const float log_alpha = middle.y - fmaf(q, q, p * p);
  const bool hit = open && log_alpha >= log_threshold;
  if (!__any_sync(kAllLanes, hit)) return;
  PixelShare<float> share{0.0f, 0.0f};
  if (hit) {
    const float plain = ex2(log_alpha);
    float alpha = fminf(plain, kAlphaMax), slope = plain < kAlphaMax ? alpha : 0.0f;
    if (middle.w != 1.0f) {
      slope *= sibling_alpha_slope(alpha, middle.w, colour.w);
      alpha = sibling_alpha(alpha, middle.w, colour.w);
    }
    open = blend_adjoint(alpha, slope, {colour.x, colour.y, colour.z}, pixel, share);
    if (!open) share = {0.0f, 0.0f};
  }
  const uint32_t lane = lane_in_warp();
  const float gp = share.g * p, gq = share.g * q;
  float most[8] = {share.g,
                   gp,
                   gq,
                   gp * p,
                   gp * q,
                   gq * q,
                   share.weight * pixel.by_colour.x,
                   share.weight * pixel.by_colour.y};
  const float sum = warp_sums(most, lane);
  const float blue = warp_sum(share.weight * pixel.by_colour.z);
  const float squares = warp_sum(share.weight * error);
  FixedSum* of = sums + size_t{chosen.slot[i]} * kSums;
  if (lane % 4 == 0) add_fixed(of + lane / 4, sum);
  if (lane == 1) add_fixed(of + 8, blue);
  if (lane == 2) add_fixed(of + 9, squares);
}

__global__ void __launch_bounds__(kThreads)
    train_blend(const __grid_constant__ BlendParams params) {
  __shared__ TrainSplats all_chosen[kWarps];
  const SplatView& splats = params.splats;
  const uint32_t tile = splats.tile_order[blockIdx.x];
  const auto columns = static_cast<uint32_t>(splats.frame.grids[0].columns);
  const unsigned warp = threadIdx.x / 32, self = lane_in_warp();
  const uint32_t part_x = tile % columns * kTile + warp % (kTile / kPartWidth) * kPartWidth;
  const uint32_t part_y = tile / columns * kTile + warp / (kTile / kPartWidth) * kTrainRows;
  const uint32_t x = part_x + self % kPartWidth, y = part_y + self / kPartWidth;
  bool open = x < params.pictures.width && y < params.pictures.height;
  PixelAdjoint<float> pixel;
  float error = 0.0f;
  if (open) {
    pixel = adjoint_at(params.pictures, y * params.pictures.width + x);
    error = squared_error(params.pictures, y * params.pictures.width + x);
  }
  const Part part{static_cast<float>(part_x) + 0.5f, static_cast<float>(part_x + kPartWidth) - 0.5f,
                  static_cast<float>(part_y) + 0.5f,
                  static_cast<float>(part_y + kTrainRows) - 0.5f};
  TrainSplats& chosen = all_chosen[warp];
  const TileList list = splats.tiles[tile];
  for (uint32_t first = list.first; first < list.last; first += 32) {
    const uint32_t at = first + self;
    RasterSplat splat{};
    uint32_t slot = 0;
    bool touches = at < list.last;
    if (touches) {
      slot = slot_of(__ldg(splats.keys + at));
      const float4* record = reinterpret_cast<const float4*>(splats.records + slot);
      splat = {__ldg(record), __ldg(record + 1), __ldg(record + 2)};
      touches = rasterize_touches(splat, part, params.log_threshold);
    }
    const unsigned lanes = __ballot_sync(kAllLanes, touches);
    __syncwarp();
    if (touches) {
      const int place = __popc(lanes & ((1u << self) - 1));
      chosen.shape[place] = splat.shape;
      chosen.middle[place] = splat.middle;
      chosen.colour[place] = splat.colour;
      chosen.slot[place] = slot;
    }
    __syncwarp();
    const int count = __popc(lanes);
    for (int i = 0; i < count; ++i)
      add_pixel(chosen, i, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f,
                params.log_threshold, error, pixel, open, params.sums);
    if (!__any_sync(kAllLanes, open)) return;
  }
}

}  // namespace

void launch_train_blend(const SplatFrame& f, const TrainPictures& pictures, float log_threshold,
                        FixedSum* sums) {
  launch_kernel("train_blend", train_blend, {f.splats.frame.count(), kThreads, f.stream},
                BlendParams{f.splats, pictures, log_threshold * kLog2e, sums});
}

}  // namespace voyager::cuda
