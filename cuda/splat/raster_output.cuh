#pragma once
// A finished pixel into the target's format: premultiplied colour over the background,
// display-referred code values (METHOD §1), rounded as runtime/frame/resolve.h rounds.
#include <cuda_fp16.h>

#include "cuda/splat/raster_pixel.cuh"
#include "cuda/splat/splat_launch.h"
#include "runtime/math/half.h"

namespace voyager::cuda {

__device__ inline uint32_t to_code(float value) {
  return static_cast<uint32_t>(fmaf(__saturatef(value), 255.0f, 0.5f));
}

__device__ inline uint32_t to_half_pair(float a, float b) {
  const auto within = [](float value) { return fminf(fmaxf(value, -kMaxHalf), kMaxHalf); };
  const __half2 pair = __floats2half2_rn(within(a), within(b));
  return *reinterpret_cast<const uint32_t*>(&pair);
}

// Surfaces are addressed in bytes along a row.
template <class T>
__device__ void write_surface(const RasterTarget& target, cudaSurfaceObject_t surface, uint32_t x,
                              uint32_t y, const T& value) {
  const int at = static_cast<int>(x * sizeof(T));
  if (target.layered)
    surf2DLayeredwrite(value, surface, at, y, target.layer);
  else
    surf2Dwrite(value, surface, at, y);
}

template <class T>
__device__ void write_color(const RasterTarget& target, uint32_t x, uint32_t y, const T& value) {
  if (target.color_surface != 0)
    write_surface(target, target.color_surface, x, y, value);
  else
    static_cast<T*>(target.color)[size_t{y} * target.width + x] = value;
}

__device__ inline void write_pixel(const RasterTarget& target, uint32_t x, uint32_t y,
                                   const RasterPixel& pixel) {
  const float through = fabsf(pixel.transmittance);
  const float r = fmaf(through, target.background.x, pixel.r);
  const float g = fmaf(through, target.background.y, pixel.g);
  const float b = fmaf(through, target.background.z, pixel.b);
  const float a = 1.0f - through;
  switch (target.format) {
    case ColorFormat::none:
      break;
    case ColorFormat::rgba8:
      write_color(target, x, y, to_code(r) | to_code(g) << 8 | to_code(b) << 16 | to_code(a) << 24);
      break;
    case ColorFormat::rgba16f:
      write_color(target, x, y, uint2{to_half_pair(r, g), to_half_pair(b, a)});
      break;
    case ColorFormat::rgba32f:
      write_color(target, x, y, float4{r, g, b, a});
      break;
  }
  if (target.depth_surface != 0)
    write_surface(target, target.depth_surface, x, y, pixel.depth);
  else if (target.depth != nullptr)
    target.depth[size_t{y} * target.width + x] = pixel.depth;
}

}  // namespace voyager::cuda
