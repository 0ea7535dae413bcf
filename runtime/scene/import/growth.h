#pragma once
// How much memory a header's count is worth: four times the Gaussians that have arrived, so that
// arrays are moved a few times only, and of what has not come no page is touched.
#include <algorithm>
#include <cstdint>
#include <memory_resource>
#include <vector>

namespace voyager {

inline void reserve_for(std::pmr::vector<float>& values, uint64_t gaussians, uint64_t announced,
                        size_t width) {
  if (values.capacity() / width >= gaussians) return;
  values.reserve(static_cast<size_t>(std::min(announced, 4 * gaussians)) * width);
}

}  // namespace voyager
