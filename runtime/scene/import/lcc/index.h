#pragma once
// The index.bin of an LCC scene: where the Gaussians of each cell are in its data.bin, at each
// level of detail.
#include <cstdint>
#include <vector>

#include "runtime/base/file.h"

namespace voyager::lcc {

inline constexpr uint64_t kRowBytes = 32;    // of a Gaussian
inline constexpr uint64_t kShRowBytes = 64;  // of its SH bands

// A cell's number, then for each level a count, an offset and a size.
constexpr uint64_t bytes_of_cell(uint64_t levels) {
  return 4 + 16 * levels;
}

struct Range {
  uint64_t offset = 0;  // bytes in the file of rows
  uint64_t count = 0;   // Gaussians
};

// Of each cell the finest level that has any Gaussians, in the order of data.bin. Throws
// Error(refused_input) where a range of any level leaves the `data_bytes` of data.bin, or one of
// these shares bytes with another, so that there are no more Gaussians than data.bin has.
std::vector<Range> finest_level(const ByteSource& index, uint64_t levels, uint64_t data_bytes);

}  // namespace voyager::lcc
