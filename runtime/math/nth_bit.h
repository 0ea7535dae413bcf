#pragma once
#include <cstdint>

#include "runtime/math/count_bits.h"

namespace voyager {

// The place of a word's n-th set bit, counted from 0. More than n bits are set.
VOYAGER_HD uint32_t nth_bit(uint32_t word, uint32_t n) {
  uint32_t place = 0;
#ifdef __CUDA_ARCH__
#pragma unroll
#endif
  for (unsigned width = 16; width != 0; width /= 2) {
    const uint32_t below = count_bits(word & ((1u << width) - 1));
    if (n < below) continue;
    n -= below, word >>= width, place += width;
  }
  return place;
}

}  // namespace voyager
