// METHOD §6–8 for one tile. Included by rasterize_*.cpp only, each of which is
// compiled for one instruction set and names its own VOYAGER_ISA namespace.
// Loops over a row's pixels are plain arrays of kTile, which the compiler turns
// into SIMD; every operation is explicit, so each width rounds alike.
#include <algorithm>
#include <atomic>
#include <limits>

#include "runtime/cpu/rasterize.h"
#include "runtime/math/alpha_lut.h"

namespace voyager::cpu::VOYAGER_ISA {
namespace {

constexpr float kAlive = -std::numeric_limits<float>::infinity();
constexpr float kEnded = 1.0f;  // above any ρ

struct alignas(64) Row {
  float r[kTile], g[kTile], b[kTile], transmittance[kTile], depth[kTile];
  float floor[kTile];  // a pixel takes splats while ρ ≥ floor
};

template <Exponential E>
inline float splat_alpha(const RasterParams& params, const Splat& s, float rho) {
  if constexpr (E == Exponential::lut) {
    const float alpha = params.lut[alpha_lut_index(rho + s.log_opacity, params.lut_scale)];
    return alpha < kAlphaMax ? alpha : kAlphaMax;
  } else {
    const float e = E == Exponential::ex2 ? exp2_negative(rho) : exp_negative(rho);
    const float alpha = s.opacity * e;
    return alpha < kAlphaMax ? alpha : kAlphaMax;
  }
}

// How far the pixels of a tile may be seen.
struct Limits {
  float z[kTile][kTile];
  float farthest;
};

inline Limits tile_limits(const DepthLimits& limits, uint32_t x0, uint32_t y0, int columns,
                          int rows) {
  Limits found = {};
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const float z = limits.at(x0 + static_cast<size_t>(x), y0 + static_cast<size_t>(y));
      found.z[y][x] = z;
      found.farthest = z > found.farthest ? z : found.farthest;
    }
  return found;
}

// Of one splat in the pixels of one row.
struct RowHits {
  float rho[kTile];
  int32_t hit[kTile];
};

// True if it hits a pixel; with kLimits only where it lies within `limit`.
template <bool kLimits>
inline bool find_hits(const Splat& s, const float* dx, float dy, const float* limit, const Row& row,
                      RowHits& of) {
  int32_t hits = 0;
  for (int i = 0; i < kTile; ++i) {
    const float p = dx[i] * s.conic.p_x;
    const float q = std::fma(-s.conic.skew, dx[i], dy) * s.conic.q_y;
    of.rho[i] = -std::fma(q, q, p * p);
    of.hit[i] = (of.rho[i] >= s.rho_min) & (of.rho[i] >= row.floor[i]);
    if constexpr (kLimits) of.hit[i] &= s.depth <= limit[i];
    hits |= of.hit[i];
  }
  return hits != 0;
}

// Whether light reaches the splat in the row: behind less than α* of it nothing is told apart.
template <bool kLimits>
inline bool is_shown(const Splat& s, const float* dx, float dy, const float* limit,
                     const Row& row) {
  RowHits of;
  find_hits<kLimits>(s, dx, dy, limit, row, of);
  int32_t shown = 0;
  for (int i = 0; i < kTile; ++i) shown |= of.hit[i] & (row.transmittance[i] >= kAlphaThreshold);
  return shown != 0;
}

// What is to be told of a splat, unless it was told already. Tiles that tell it at once tell the
// same.
inline Shown* untold(const RasterParams& params, uint32_t splat) {
  if (params.shown == nullptr) return nullptr;
  Shown* const shown = params.shown[splat];
  const bool told =
      shown == nullptr || std::atomic_ref(*shown).load(std::memory_order_relaxed) == Shown::yes;
  return told ? nullptr : shown;
}

// Blends one splat into one row. Returns true if a pixel ended.
template <Exponential E, bool kFilter, bool kDepth, bool kLimits, bool kSiblings>
inline bool blend_row(const RasterParams& params, const Splat& s, const float* dx, float dy,
                      const float* limit, Row& row) {
  RowHits of;
  const bool hits = find_hits<kLimits>(s, dx, dy, limit, row, of);
  if (kFilter && !hits) return false;
  const float* const rho = of.rho;
  const int32_t* const hit = of.hit;

  int32_t ended = 0;
  for (int i = 0; i < kTile; ++i) {
    float alpha = splat_alpha<E>(params, s, rho[i]);
    if constexpr (kSiblings) alpha = sibling_alpha(alpha, s.t, s.inverse_k);
    const float before = row.transmittance[i];
    const float after = std::fma(-alpha, before, before);
    const int32_t ends = hit[i] & (after < kTransmittanceEnd);
    const int32_t blends = hit[i] & (ends ^ 1);
    const float weight = blends ? alpha * before : 0.0f;
    row.r[i] = std::fma(weight, s.colour.x, row.r[i]);
    row.g[i] = std::fma(weight, s.colour.y, row.g[i]);
    row.b[i] = std::fma(weight, s.colour.z, row.b[i]);
    row.transmittance[i] = blends ? after : before;
    row.floor[i] = ends ? kEnded : row.floor[i];
    if constexpr (kDepth)
      row.depth[i] = (blends & (before > 0.5f) & (after <= 0.5f)) ? s.depth : row.depth[i];
    ended |= ends;
  }
  return ended != 0;
}

inline bool all_ended(const Row& row, int columns) {
  for (int i = 0; i < columns; ++i)
    if (row.floor[i] != kEnded) return false;
  return true;
}

// The rows of the tile that the support's box reaches.
inline TileRange splat_rows(const Splat& s, float y0, int rows) {
  const float first = std::floor(s.y - s.half_height - y0 - 1.0f),
              last = std::ceil(s.y + s.half_height - y0 + 1.0f);
  return {first > 0.0f ? static_cast<int32_t>(first) : 0,
          last < static_cast<float>(rows) ? static_cast<int32_t>(last) : rows};
}

template <Exponential E, bool kFilter, bool kDepth, bool kLimits>
void rasterize_tile(const RasterParams& params, const Tile& tile) {
  const uint32_t x0 = tile.column * kTile, y0 = tile.row * kTile;
  const int columns = static_cast<int>(std::min<uint32_t>(kTile, params.width - x0));
  const int rows = static_cast<int>(std::min<uint32_t>(kTile, params.height - y0));
  Row image[kTile];
  for (Row& row : image)
    for (int i = 0; i < kTile; ++i) {
      row.r[i] = row.g[i] = row.b[i] = 0.0f;
      row.transmittance[i] = 1.0f;
      row.depth[i] = std::numeric_limits<float>::infinity();
      row.floor[i] = i < columns ? kAlive : kEnded;
    }

  Limits limits;
  if constexpr (kLimits) limits = tile_limits(params.limits, x0, y0, columns, rows);
  uint32_t open_rows = (1u << rows) - 1u;
  for (const uint32_t index : tile.splats) {
    const Splat& s = params.splats[index];
    if (kLimits && s.depth > limits.farthest) break;
    float dx[kTile];
    for (int i = 0; i < kTile; ++i)
      dx[i] = (static_cast<float>(x0) + static_cast<float>(i) + 0.5f) - s.x;
    Shown* shown = untold(params, index);
    const TileRange reach =
        kFilter ? splat_rows(s, static_cast<float>(y0), rows) : TileRange{0, rows};
    for (int y = reach.begin; y < reach.end; ++y) {
      if (!(open_rows >> y & 1u)) continue;
      const float dy = (static_cast<float>(y0) + static_cast<float>(y) + 0.5f) - s.y;
      const float* limit = kLimits ? limits.z[y] : nullptr;
      Row& row = image[y];
      if (shown != nullptr && is_shown<kLimits>(s, dx, dy, limit, row)) {
        std::atomic_ref(*shown).store(Shown::yes, std::memory_order_relaxed);
        shown = nullptr;
      }
      const bool ended =
          s.t == 1.0f ? blend_row<E, kFilter, kDepth, kLimits, false>(params, s, dx, dy, limit, row)
                      : blend_row<E, kFilter, kDepth, kLimits, true>(params, s, dx, dy, limit, row);
      if (ended && all_ended(row, columns)) open_rows &= ~(1u << y);
    }
    if (open_rows == 0) break;
  }

  for (int y = 0; y < rows; ++y) {
    const size_t first = (y0 + static_cast<size_t>(y)) * params.width + x0;
    for (int i = 0; i < columns; ++i)
      params.pixels[first + static_cast<size_t>(i)] = {image[y].r[i], image[y].g[i], image[y].b[i],
                                                       image[y].transmittance[i]};
    if constexpr (kDepth)
      for (int i = 0; i < columns; ++i)
        params.depth[first + static_cast<size_t>(i)] = image[y].depth[i];
  }
}

template <Exponential E>
RasterizeTile pick_for(bool filter, bool depth, bool limits) {
  if (limits)
    return filter ? rasterize_tile<E, true, true, true> : rasterize_tile<E, false, true, true>;
  if (filter)
    return depth ? rasterize_tile<E, true, true, false> : rasterize_tile<E, true, false, false>;
  return depth ? rasterize_tile<E, false, true, false> : rasterize_tile<E, false, false, false>;
}

}  // namespace

RasterizeTile pick(Exponential exponential, bool filter, bool depth, bool limits) {
  switch (exponential) {
    case Exponential::ex2:
      return pick_for<Exponential::ex2>(filter, depth, limits);
    case Exponential::lut:
      return pick_for<Exponential::lut>(filter, depth, limits);
    case Exponential::exact:
    case Exponential::half2:  // refused before a frame
      break;
  }
  return pick_for<Exponential::exact>(filter, depth, limits);
}

}  // namespace voyager::cpu::VOYAGER_ISA
