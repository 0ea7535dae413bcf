#pragma once
// How much memory a header's count is worth: at most about four times the Gaussians that have
// arrived, so that of what has not come no page is touched. Arrays are moved a few times only, the
// last time when a quarter is there, so that old and new together are little more than the whole.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory_resource>
#include <span>
#include <vector>

#include "runtime/base/file.h"

namespace voyager {

// The smallest of announced, announced / 4, announced / 16, ... that holds `gaussians`.
inline uint64_t room_for(uint64_t gaussians, uint64_t announced) {
  uint64_t room = announced;
  while (room / 4 >= gaussians && room / 4 > 0) room /= 4;
  return room;
}

inline void reserve_for(std::pmr::vector<float>& values, uint64_t gaussians, uint64_t announced,
                        size_t width) {
  if (values.capacity() / width >= gaussians) return;
  values.reserve(static_cast<size_t>(room_for(gaussians, announced)) * width);
}

// The next `count` bytes, fewer at the end of the stream.
inline std::vector<std::byte> read_as_they_come(ByteReader& reader, uint64_t count) {
  constexpr uint64_t kFirst = 1 << 20;
  std::vector<std::byte> bytes;
  while (bytes.size() < count) {
    const size_t had = bytes.size();
    const uint64_t more = std::min(count - had, std::max<uint64_t>(kFirst, had));
    bytes.resize(had + static_cast<size_t>(more));
    const size_t got = reader.read(std::span(bytes).subspan(had));
    bytes.resize(had + got);
    if (got < more) break;
  }
  return bytes;
}

}  // namespace voyager
