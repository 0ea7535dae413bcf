#pragma once
// A binary32 number as its bits, and back.
#include <cstdint>
#include <cstring>

#include "runtime/math/host_device.h"

namespace voyager {

VOYAGER_HD uint32_t float_bits(float x) {
  uint32_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}
VOYAGER_HD float bits_float(uint32_t bits) {
  float x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

}  // namespace voyager
