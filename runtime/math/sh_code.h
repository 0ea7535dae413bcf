#pragma once
// SH coefficients as compact storage has them (docs/voy-format.md): the constant in binary16, the
// others as signed steps of the largest of their band in the chunk. In memory they are rows of
// bytes, one a Gaussian: the number of the chunk's scales, the constant, the steps.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>

#include "runtime/math/half.h"
#include "runtime/math/sh.h"

namespace voyager {

// First coefficient of bands 1, 2 and 3, and the end.
inline constexpr std::array<int, 4> kShBandStart = {1, 4, 9, 16};
inline constexpr std::array<int, 3> kShSteps = {127, 31, 31};

// Error: scale / (2 * steps).
inline int8_t quantise_sh(float coefficient, float scale, int steps) {
  if (scale == 0) return 0;
  return static_cast<int8_t>(std::nearbyint(static_cast<double>(coefficient) / scale * steps));
}
inline float restore_sh(int8_t q, float scale, int steps) {
  return static_cast<float>(static_cast<double>(q) / steps * scale);
}

using ShScales = std::array<float, 3>;  // of bands 1 to 3

// restore_sh() of a byte, less the scale: a division takes longer than all the rest of a row.
constexpr std::array<double, 256> sh_shares(int steps) {
  std::array<double, 256> shares{};
  for (int byte = 0; byte < 256; ++byte)
    shares[static_cast<size_t>(byte)] = static_cast<double>(byte < 128 ? byte : byte - 256) / steps;
  return shares;
}
inline constexpr std::array<std::array<double, 256>, 3> kShShares = {
    sh_shares(kShSteps[0]), sh_shares(kShSteps[1]), sh_shares(kShSteps[2])};

// Bytes of a row, a multiple of 4.
constexpr size_t sh_row_bytes(int degree) {
  return (sizeof(uint32_t) + 3 * sizeof(uint16_t) +
          3 * static_cast<size_t>(sh_coefficients(degree) - 1) + 3) /
         4 * 4;
}

// sh: [k][rgb], restored with these scales before. They come back to the bit.
inline void pack_sh(const float* sh, int degree, uint32_t scales, const ShScales& scale,
                    uint8_t* row) {
  std::memcpy(row, &scales, sizeof scales);
  row += sizeof scales;
  for (int c = 0; c < 3; ++c) {
    const uint16_t constant = float_to_half(sh[c]);
    std::memcpy(row + 2 * c, &constant, sizeof constant);
  }
  row += 3 * sizeof(uint16_t) - 3;  // steps begin with coefficient 1
  for (size_t band = 0; band < 3 && static_cast<int>(band) < degree; ++band)
    for (int k = 3 * kShBandStart[band]; k < 3 * kShBandStart[band + 1]; ++k)
      row[k] = static_cast<uint8_t>(quantise_sh(sh[k], scale[band], kShSteps[band]));
}

inline void unpack_sh(const uint8_t* __restrict row, int degree, const ShScales* __restrict scales,
                      float* __restrict sh) {
  uint32_t of;
  std::memcpy(&of, row, sizeof of);
  const ShScales scale = scales[of];
  row += sizeof of;
  for (int c = 0; c < 3; ++c) {
    uint16_t constant;
    std::memcpy(&constant, row + 2 * c, sizeof constant);
    sh[c] = half_to_float(constant);
  }
  row += 3 * sizeof(uint16_t) - 3;
  for (size_t band = 0; band < 3 && static_cast<int>(band) < degree; ++band)
    for (int k = 3 * kShBandStart[band]; k < 3 * kShBandStart[band + 1]; ++k)
      sh[k] = static_cast<float>(kShShares[band][row[k]] * scale[band]);
}

}  // namespace voyager
