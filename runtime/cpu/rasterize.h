#pragma once
// The CPU's rasterize stage: one tile. The kernel is compiled once for each
// instruction set (rasterize_*.cpp) from one source, with the same results to
// the bit, and picked at run time.
#include <cstdint>
#include <span>

#include "runtime/frame/backend.h"
#include "runtime/stages/bin.h"
#include "runtime/stream/shown_chunks.h"

namespace voyager::cpu {

// Per-pixel results, premultiplied, before the background.
struct Pixel {
  float r, g, b, transmittance;
};

struct RasterParams {
  const Splat* splats;
  const float* lut;  // lut_size + 1 entries, for Exponential::lut
  float lut_scale;   // lut_size / kLutRange
  uint32_t width, height;
  Pixel* pixels;  // width * height
  float* depth;   // width * height, or null
  DepthLimits limits;
  Shown* const* shown = nullptr;  // by splat, what is told of it, or null; null: of none
};

struct Tile {
  uint32_t column, row;
  std::span<const uint32_t> splats;  // in depth order
};

using RasterizeTile = void (*)(const RasterParams&, const Tile&);

// limits: only with depth. The specialisation for the widest instruction set of this machine.
RasterizeTile pick_rasterizer(Exponential exponential, bool alpha_filter, bool depth, bool limits);

// Every instruction set that this machine can run, for the test that they agree.
struct NamedRasterizer {
  const char* name;
  RasterizeTile (*pick)(Exponential, bool alpha_filter, bool depth, bool limits);
};
std::span<const NamedRasterizer> rasterizers();

}  // namespace voyager::cpu
