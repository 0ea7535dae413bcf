#pragma once
// How much memory a header's count is worth. A quarter of the Gaussians must
// have arrived before the announced count is believed and reserved at once;
// before that, arrays grow with what has arrived.
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace voyager {

inline void reserve_for(std::pmr::vector<float>& values, uint64_t gaussians, uint64_t announced,
                        size_t width) {
  if (values.capacity() / width >= gaussians) return;
  const uint64_t capacity = announced / 4 <= gaussians ? announced : gaussians + gaussians / 4;
  values.reserve(static_cast<size_t>(capacity) * width);
}

}  // namespace voyager
