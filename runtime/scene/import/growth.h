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
// nodes, where one takes `gaussian` bytes of memory: 32 MiB of them, and 256 bytes more for each
// byte of the file. That is several times what scenes of one colour are compressed by, and a
// fraction of what zeros are.
inline uint64_t most_gaussians(uint64_t file_bytes, uint64_t gaussian) {
  constexpr uint64_t kFreeBytes = 32 << 20, kBytesOfAByte = 256;
  return (kFreeBytes + std::min(file_bytes, uint64_t{1} << 40) * kBytesOfAByte) / gaussian;
}

// The parts that a file of so many bytes may place: each of its nodes places each primitive of a
// mesh.
inline uint64_t most_parts(uint64_t file_bytes) {
  constexpr uint64_t kFreeParts = 1 << 16, kBytesOfAPart = 16;
  return kFreeParts + file_bytes / kBytesOfAPart;
}

// Bytes of a Gaussian in a GaussianCloud.
inline uint64_t bytes_of_gaussian(int sh_degree) {
  return (11 + 3 * static_cast<uint64_t>(sh_coefficients(sh_degree))) * sizeof(float);
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

// All of a source, whose size may be a server's claim.
inline std::vector<std::byte> read_all(const ByteSource& source) {
  return read_as_they_come(*read_source(source), source.size());
}

}  // namespace voyager
