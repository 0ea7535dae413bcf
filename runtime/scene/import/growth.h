#pragma once
// How much memory a header's count is worth: at most about four times the Gaussians that have
// arrived, so that of what has not come no page is touched. Arrays are moved a few times only, the
// last time when a quarter is there, so that old and new together are little more than the whole.
#include <algorithm>
#include <cstdint>
#include <memory_resource>
#include <vector>

#include "runtime/math/sh.h"

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

// The Gaussians that a file of so many bytes is worth, in which they may be compressed or shared by
// nodes: as many as take 32 MiB, and 256 bytes more for each byte of the file. That is several
// times what scenes of one colour are compressed by, and a fraction of what zeros are.
inline uint64_t most_gaussians(uint64_t file_bytes, int sh_degree) {
  constexpr uint64_t kFreeBytes = 32 << 20, kBytesOfAByte = 256;
  const auto coefficients = static_cast<uint64_t>(sh_coefficients(sh_degree));
  const uint64_t gaussian = (11 + 3 * coefficients) * sizeof(float);
  return (kFreeBytes + std::min(file_bytes, uint64_t{1} << 40) * kBytesOfAByte) / gaussian;
}

// The parts that a file of so many bytes may place: each of its nodes places each primitive of a
// mesh.
inline uint64_t most_parts(uint64_t file_bytes) {
  constexpr uint64_t kFreeParts = 1 << 16, kBytesOfAPart = 16;
  return kFreeParts + file_bytes / kBytesOfAPart;
}

}  // namespace voyager
