#pragma once
#include <bit>
#include <cstdint>

#include "runtime/math/host_device.h"

namespace voyager {

VOYAGER_HD uint32_t bit_count(uint32_t word) {
#ifdef __CUDA_ARCH__
  return static_cast<uint32_t>(__popc(word));
#else
  return static_cast<uint32_t>(std::popcount(word));
#endif
}

}  // namespace voyager
