#pragma once
#include <cstdint>

namespace voyager::cuda {

// Places of a list that are left out and bounded together.
inline constexpr uint32_t kRowPlaces = 32;

}  // namespace voyager::cuda
