#pragma once
// Halton's sequence: points spread evenly, however many of them are taken.
#include <cstdint>

namespace voyager {

// The k-th of one coordinate, in [0, 1); each coordinate has a prime base of its own.
inline double radical_inverse(uint64_t k, uint32_t base) {
  double value = 0, digit = 1;
  for (; k != 0; k /= base) {
    digit /= base;
    value += digit * static_cast<double>(k % base);
  }
  return value;
}

}  // namespace voyager
