#pragma once
#include <cstdint>

#include "runtime/math/host_device.h"

namespace voyager {

// By arithmetic on the host: a machine may lack the instruction.
VOYAGER_HD uint32_t count_bits(uint32_t word) {
#ifdef __CUDA_ARCH__
  return static_cast<uint32_t>(__popc(word));
#else
  word -= word >> 1 & 0x55555555u;
  word = (word & 0x33333333u) + (word >> 2 & 0x33333333u);
  return ((word + (word >> 4)) & 0x0f0f0f0fu) * 0x01010101u >> 24;
#endif
}

}  // namespace voyager
