#pragma once
#include <cstdint>

namespace host {

inline constexpr uint32_t kFramesInFlight = 2;

}  // namespace host
