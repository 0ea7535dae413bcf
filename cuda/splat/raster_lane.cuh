#pragma once
// A lane's pixels, and how one splat is blended into them; as the exponential wants it.
#include <cuda_fp16.h>

#include "cuda/device/warp.cuh"
#include "cuda/splat/raster_pixel.cuh"
#include "runtime/math/half.h"

namespace voyager::cuda {

inline constexpr int kPartWidth = 8;               // pixels of a warp's part; a lane has a column
inline constexpr int kLaneRows = 32 / kPartWidth;  // from one of a lane's rows to its next

// What a kernel is compiled for.
template <Exponential E, bool kFilterOn, bool kSiblingsIn, bool kDepthOut, bool kCounting,
          bool kLimitsIn = false>
struct Mode {
  static constexpr Exponential kExponential = E;
  static constexpr bool kFilter = kFilterOn, kSiblings = kSiblingsIn, kDepth = kDepthOut,
                        kCount = kCounting, kLimits = kLimitsIn;
};

struct Counts {
  uint32_t evaluated = 0, blended = 0;
};

struct Lut {
  const float* entries;
  float scale;
};

// A splat as it is blended: a SplatRecord, its colour as the lane wants it.
struct RasterSplat {
  float4 shape;   // x, y, p_x, q_y
  float4 middle;  // skew, log o, depth, t
  float4 colour;  // r, g, b, 1/k
};

// -log α of the lane's pixels. below: rows from y to the first of them. A pixel's bits do not
// depend on how many rows its lane has: both ways find it from the row that two would begin with.
template <int kRows>
__device__ inline void lane_logarithms(float x, float y, float below, const float4& shape,
                                       const float4& middle, float (&minus_log)[kRows]) {
  const float dx = x - shape.x, dy = y - shape.y;
  const float p = dx * shape.z, q0 = fmaf(-middle.x, dx, dy) * shape.w;
  const float base = fmaf(p, p, -middle.y);
#pragma unroll
  for (int row = 0; row < kRows; ++row) {
    const float q = kRows == 1 ? fmaf(below, shape.w, q0)
                    : row == 0 ? q0
                               : fmaf(static_cast<float>(row * kLaneRows), shape.w, q0);
    minus_log[row] = fmaf(q, q, base);
  }
}

// In binary32.
template <class M, int kPixels>
struct FloatLane {
  static constexpr int kRows = kPixels;
  float x, y, below;  // the centre of the first, and rows from y to it
  float limit;        // splats contribute while their -log α is no more
  RasterPixel pixels[kRows];

  __device__ FloatLane(float centre_x, float centre_y, int rows_below, float most)
      : x(centre_x), y(centre_y), below(static_cast<float>(rows_below)), limit(most) {}
  __device__ void end(int row) { pixels[row].end(); }
  __device__ bool ended(int row) const { return pixels[row].ended(); }
  __device__ void set_farthest(int row, float z) { pixels[row].farthest = z; }
  __device__ float farthest(int row) const { return pixels[row].farthest; }
  __device__ RasterPixel pixel(int row) const { return pixels[row]; }
  static __device__ float4 prepare(const float4& colour) { return colour; }

  // Without a branch but for many siblings, so that the splats of a loop overlap: the compiler
  // makes predicates of what is conditional. A splat that misses a pixel is blended into it with an
  // α of 0.
  template <Siblings kMost>
  __device__ void blend(const float4& shape, const float4& middle, const float4& colour,
                        const Lut& lut, Counts& counts) {
    constexpr Exponential E = M::kExponential;
    float minus_log[kRows];
    lane_logarithms(x, y, below, shape, middle, minus_log);
    float r = colour.x, g = colour.y, b = colour.z;
    asm volatile("" : "+f"(r), "+f"(g), "+f"(b));  // read once, not for each pixel
#pragma unroll
    for (int row = 0; row < kRows; ++row) {
      RasterPixel& pixel = pixels[row];
      bool hit = minus_log[row] <= limit;
      if constexpr (M::kLimits) hit = hit && middle.z <= pixel.farthest;
      float alpha = alpha_of<E>(-minus_log[row], lut.entries, lut.scale);
      alpha = blended_alpha<E, kMost>(alpha, middle.w, colour.w);
      alpha = hit ? alpha : 0.0f;
      const float before = pixel.transmittance, after = fmaf(-alpha, before, before);
      const bool goes_on = after >= kTransmittanceEnd;  // false of what has ended
      if (goes_on) {
        const float weight = alpha * before;
        pixel.r = fmaf(weight, r, pixel.r);
        pixel.g = fmaf(weight, g, pixel.g);
        pixel.b = fmaf(weight, b, pixel.b);
      }
      pixel.transmittance = goes_on ? after : -fabsf(before);
      if constexpr (M::kDepth) {
        const bool found = pixel.transmittance <= pixel.halfway;
        pixel.depth = found ? middle.z : pixel.depth;
        pixel.halfway = found ? -1.0f : pixel.halfway;
      }
      if constexpr (M::kCount) counts.evaluated += 1, counts.blended += hit && goes_on;
    }
  }
};

// Two pixels in one register from the exponential on, blending in binary16. What contributes
// is still told in binary32.
template <class M>
struct HalfLane {
  static constexpr int kRows = 2;
  float x, y;
  __half2 r{}, g{}, b{}, transmittance;
  float limits[kRows];  // the -log α up to which splats contribute; -inf once the pixel has ended
  float depth[kRows] = {kInfinity, kInfinity}, halfway[kRows] = {0.5f, 0.5f};
  float farthest_z[kRows];

  __device__ HalfLane(float centre_x, float centre_y, int, float most)
      : x(centre_x), y(centre_y), transmittance(__float2half2_rn(1.0f)), limits{most, most} {}
  __device__ void end(int row) { limits[row] = -kInfinity; }
  __device__ bool ended(int row) const { return limits[row] == -kInfinity; }
  __device__ void set_farthest(int row, float z) { farthest_z[row] = z; }
  __device__ float farthest(int row) const { return farthest_z[row]; }
  __device__ RasterPixel pixel(int row) const {
    const auto of = [row](__half2 pair) {
      return row == 0 ? __low2float(pair) : __high2float(pair);
    };
    RasterPixel pixel;
    pixel.r = of(r), pixel.g = of(g), pixel.b = of(b);
    pixel.transmittance = of(transmittance);
    pixel.depth = depth[row];
    return pixel;
  }
  // Each channel twice.
  static __device__ float4 prepare(const float4& colour) {
    const auto twice = [](float channel) {
      return __uint_as_float(bits(__float2half2_rn(fminf(channel, kMaxHalf))));
    };
    return {twice(colour.x), twice(colour.y), twice(colour.z), colour.w};
  }

  template <Siblings kMost>
  __device__ void blend(const float4& shape, const float4& middle, const float4& colour, const Lut&,
                        Counts& counts) {
    float minus_log[kRows];
    lane_logarithms(x, y, 0.0f, shape, middle, minus_log);
    // What does not contribute has an α of 2^-∞.
    bool hits[kRows] = {minus_log[0] <= limits[0], minus_log[1] <= limits[1]};
    if constexpr (M::kLimits)
      for (int row = 0; row < kRows; ++row) hits[row] = hits[row] && middle.z <= farthest_z[row];
    const float exponents[kRows] = {hits[0] ? -minus_log[0] : -kInfinity,
                                    hits[1] ? -minus_log[1] : -kInfinity};
    __half2 alpha =
        __hmin2(h2exp2(__floats2half2_rn(exponents[0], exponents[1])), __float2half2_rn(kAlphaMax));
    if constexpr (kMost != Siblings::none) {
      constexpr Exponential E = M::kExponential;
      const float each[kRows] = {blended_alpha<E, kMost>(__low2float(alpha), middle.w, colour.w),
                                 blended_alpha<E, kMost>(__high2float(alpha), middle.w, colour.w)};
      alpha = __floats2half2_rn(each[0], each[1]);
    }
    __half2 after = __hfma2(__hneg2(alpha), transmittance, transmittance);
    __half2 weight = __hmul2(alpha, transmittance);
    if constexpr (M::kCount) counts.evaluated += kRows, counts.blended += hits[0] + hits[1];
    const __half2 end = __float2half2_rn(kTransmittanceEnd);
    if (__any_sync(kAllLanes, !__hbge2(after, end))) {
      const bool ends[kRows] = {__low2half(after) < __low2half(end),
                                __high2half(after) < __low2half(end)};
      keep(ends, weight, after);
      if constexpr (M::kCount) counts.blended -= ends[0] + ends[1];
    }
    transmittance = after;
    r = __hfma2(weight, pair(colour.x), r);
    g = __hfma2(weight, pair(colour.y), g);
    b = __hfma2(weight, pair(colour.z), b);
    if constexpr (M::kDepth) find_depth(middle.z);
  }

 private:
  static __device__ uint32_t bits(__half2 pair) {
    return *reinterpret_cast<const uint32_t*>(&pair);
  }
  static __device__ __half2 pair(float channel) {
    const uint32_t bits = __float_as_uint(channel);
    return *reinterpret_cast<const __half2*>(&bits);
  }
  // A pixel that ends stays as it was.
  __device__ void keep(const bool (&ends)[kRows], __half2& weight, __half2& after) {
    const __half zero = __float2half_rn(0.0f);
    weight =
        __halves2half2(ends[0] ? zero : __low2half(weight), ends[1] ? zero : __high2half(weight));
    after = __halves2half2(ends[0] ? __low2half(transmittance) : __low2half(after),
                           ends[1] ? __high2half(transmittance) : __high2half(after));
#pragma unroll
    for (int row = 0; row < kRows; ++row)
      if (ends[row]) end(row);
  }
  __device__ void find_depth(float z) {
    const float now[kRows] = {__low2float(transmittance), __high2float(transmittance)};
#pragma unroll
    for (int row = 0; row < kRows; ++row) {
      const bool found = now[row] <= halfway[row];
      depth[row] = found ? z : depth[row];
      halfway[row] = found ? -1.0f : halfway[row];
    }
  }
};

template <class M, int kPixels, Exponential E = M::kExponential>
struct LaneOf {
  using Type = FloatLane<M, kPixels>;
};
template <class M, int kPixels>
struct LaneOf<M, kPixels, Exponential::half2> {
  using Type = HalfLane<M>;
};

}  // namespace voyager::cuda
