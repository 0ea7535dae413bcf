#pragma once
// SH coefficients as compact storage has them (docs/voy-format.md): the constant in binary16, the
// others as signed steps of the largest of their band in the chunk. In memory they are rows, one a
// Gaussian; those of one chunk have its scales in common (code_groups.h).
#include <algorithm>
#include <array>
#include <bit>
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

// What a step of each band stands for, as a sum of two binary32 numbers: fma(step, high, step *
// low) is restore_sh() to the bit, for scales from 1e-30 on. No such product lies in the middle
// between two binary32 numbers: divided by 31 or 127 it has 24 significant bits at most, or no end.
// Padded, so that a device reads it at once.
struct alignas(16) ShStepSizes {
  float high[3], low[3];
  float unused[2];
};
inline ShStepSizes step_sizes(const ShScales& scales) {
  ShStepSizes sizes{};
  for (size_t band = 0; band < scales.size(); ++band) {
    // The remainder of a division is exact. (The same in binary64 is compiled wrongly by GCC 12.)
    const auto steps = static_cast<float>(kShSteps[band]);
    sizes.high[band] = scales[band] / steps;
    sizes.low[band] = std::fma(-sizes.high[band], steps, scales[band]) / steps;
  }
  return sizes;
}

// A row: the constant, 3 * 2 bytes; band 1, 9 bytes; one that is 0; then the other bands, 6 bits a
// step, each above -32. What is left over is 0. The last word is not SH: it holds two scales
// (shape_code.h), for which rows of degrees 2 and 3 have room.
inline constexpr int kShBandOneAt = 6, kShSixBitsAt = 16, kShOffset = 32;
static_assert(kShSteps[1] == 31 && kShSteps[2] == 31);
static_assert(std::endian::native == std::endian::little);  // bytes are written, words are read

// A byte that no coefficient needs. pack_sh() makes it 0; a device's pool keeps something there.
VOYAGER_HD constexpr uint32_t sh_spare_byte(int degree) {
  return degree == 0 ? kShBandOneAt : kShSixBitsAt - 1;
}

// A multiple of 4, and of 16 where that wastes nothing.
VOYAGER_HD constexpr uint32_t sh_row_bytes(int degree) {
  constexpr uint32_t kBytes[] = {12, 20, 32, 48};
  return kBytes[degree];
}

inline void put_last_word(uint32_t word, int degree, uint8_t* row) {
  std::memcpy(row + sh_row_bytes(degree) - sizeof word, &word, sizeof word);
}
inline uint32_t last_word(const uint8_t* row, int degree) {
  uint32_t word;
  std::memcpy(&word, row + sh_row_bytes(degree) - sizeof word, sizeof word);
  return word;
}

// restore_sh() of a step, less the scale: a division takes longer than all the rest of a row.
template <size_t kCount>
constexpr std::array<double, kCount> sh_shares(int steps) {
  constexpr size_t kZero = kCount / 2;
  std::array<double, kCount> shares{};
  for (size_t i = 0; i < kCount; ++i)
    shares[i] = (static_cast<double>(i) - static_cast<double>(kZero)) / steps;
  return shares;
}
inline constexpr auto kShBandOneShares = sh_shares<256>(kShSteps[0]);
inline constexpr auto kShSixBitShares = sh_shares<64>(kShSteps[1]);

// What restored coefficients times that are, but for rounding: their steps.
inline double steps_a_unit(float scale, int steps) {
  return scale == 0 ? 0 : steps / double{scale};
}
inline int restored_step(float coefficient, double steps_a_unit) {
  // Of so large a number the last bit is worth one: adding rounds, without a branch on the sign.
  constexpr double kWhole = 0x1.8p52;
  const double rounded = coefficient * steps_a_unit + kWhole;
  return static_cast<int>(std::bit_cast<int64_t>(rounded) - std::bit_cast<int64_t>(kWhole));
}

// sh: [k][rgb], restored with these scales before. They come back to the bit. The last word is 0.
inline void pack_sh(const float* sh, int degree, const ShScales& scale, uint8_t* row) {
  std::memset(row, 0, sh_row_bytes(degree));
  for (int c = 0; c < 3; ++c) {
    const uint16_t constant = float_to_half(sh[c]);
    std::memcpy(row + 2 * c, &constant, sizeof constant);
  }
  if (degree == 0) return;
  const double a_unit[] = {steps_a_unit(scale[0], kShSteps[0]), steps_a_unit(scale[1], kShSteps[1]),
                           steps_a_unit(scale[2], kShSteps[2])};
  for (int i = 0; i < 9; ++i)
    row[kShBandOneAt + i] = static_cast<uint8_t>(restored_step(sh[3 + i], a_unit[0]));
  const int first = 3 * kShBandStart[1], count = 3 * sh_coefficients(degree) - first;
  for (int i = 0; i < count; ++i) {
    const double of = first + i < 3 * kShBandStart[2] ? a_unit[1] : a_unit[2];
    const int step = restored_step(sh[first + i], of) + kShOffset;
    uint8_t* const at = row + kShSixBitsAt + 6 * i / 8;
    const int up = 6 * i % 8;
    at[0] = static_cast<uint8_t>(at[0] | step << up);
    if (up > 2) at[1] = static_cast<uint8_t>(step >> (8 - up));
  }
}

// The row of a lower degree, with the same last word.
inline void shorten_sh(const uint8_t* row, int degree, int lower, uint8_t* into) {
  constexpr std::array<size_t, 3> kUsed = {6, 15, 28};  // bytes
  std::memset(into, 0, sh_row_bytes(lower));
  std::memcpy(into, row, kUsed[static_cast<size_t>(lower)]);
  if (lower == 2) into[27] &= 3;  // the rest is band 3's
  put_last_word(last_word(row, degree), lower, into);
}

inline void unpack_sh(const uint8_t* __restrict row, int degree, const ShScales& scale,
                      float* __restrict sh) {
  for (int c = 0; c < 3; ++c) {
    uint16_t constant;
    std::memcpy(&constant, row + 2 * c, sizeof constant);
    sh[c] = half_to_float(constant);
  }
  if (degree == 0) return;
  for (int i = 0; i < 9; ++i)
    sh[3 + i] = static_cast<float>(kShBandOneShares[row[kShBandOneAt + i] ^ 128u] * scale[0]);
  const int first = 3 * kShBandStart[1], count = 3 * sh_coefficients(degree) - first;
  for (int at = 0; at < count; at += 4) {
    uint32_t four;  // steps, and a byte behind them
    std::memcpy(&four, row + kShSixBitsAt + 3 * at / 4, sizeof four);
    for (int i = at; i < std::min(count, at + 4); ++i, four >>= 6) {
      const float of = first + i < 3 * kShBandStart[2] ? scale[1] : scale[2];
      sh[first + i] = static_cast<float>(kShSixBitShares[four & 63u] * of);
    }
  }
}

}  // namespace voyager
