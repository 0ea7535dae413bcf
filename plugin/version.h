#pragma once
#include <cstdint>

namespace voyager {

constexpr uint32_t major_version(uint32_t version) {
  return version >> 22;
}
constexpr uint32_t minor_version(uint32_t version) {
  return version >> 12 & 0x3ff;
}

// Whether a library of one API version serves a host of another: voyager.h,
// VOY_MAKE_VERSION.
constexpr bool serves(uint32_t library, uint32_t host) {
  return major_version(host) == major_version(library) &&
         minor_version(host) <= minor_version(library);
}

}  // namespace voyager
