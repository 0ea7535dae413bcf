#pragma once
// Numbers in bytes that are aligned to nothing.
#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstring>

namespace voyager {

template <class T>
T load(const std::byte* from, bool big_endian = false) {
  std::byte bytes[sizeof(T)];
  std::memcpy(bytes, from, sizeof(T));
  if (big_endian != (std::endian::native == std::endian::big))
    std::reverse(bytes, bytes + sizeof(T));
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

inline int integer(std::byte b) {
  return std::to_integer<int>(b);
}

}  // namespace voyager
