#pragma once
// METHOD §6: front to back by the sort key z, ties by id.
#include <cstdint>
#include <span>

#include "runtime/base/workers.h"
#include "runtime/math/alpha.h"

namespace voyager {

// z > 0, so its bits ascend as it does; index ascends with the id.
inline uint64_t depth_key(float z, uint32_t index) {
  return uint64_t{float_bits(z)} << 32 | index;
}
inline uint32_t depth_key_index(uint64_t key) {
  return static_cast<uint32_t>(key);
}

inline void sort_by_depth(std::span<uint64_t> keys, Workers& workers) {
  workers.sort(keys.begin(), keys.end(), [](uint64_t a, uint64_t b) { return a < b; });
}

}  // namespace voyager
