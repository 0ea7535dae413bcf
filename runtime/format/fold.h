#pragma once
#include <cstdint>

namespace voyager {

// Small differences of either sign become small numbers.
inline uint32_t fold(uint32_t difference) {
  return (difference << 1) ^ (difference >> 31 ? 0xffffffffu : 0u);
}
inline uint32_t unfold(uint32_t folded) {
  return (folded >> 1) ^ (folded & 1 ? 0xffffffffu : 0u);
}

}  // namespace voyager
