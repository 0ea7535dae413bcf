#include "runtime/scene/import/lcc/index.h"

#include <algorithm>
#include <string>

#include "runtime/scene/import/growth.h"
#include "runtime/scene/import/load.h"
#include "runtime/scene/import/refuse.h"

namespace voyager::lcc {
namespace {

constexpr uint64_t kCellNumber = 4, kLevelBytes = 16;

// `at` is where the level begins in index.bin.
Range range_of(const ByteSource& index, const std::byte* level, uint64_t at, uint64_t data_bytes) {
  const Range range{load<uint64_t>(level + 4), load<uint32_t>(level)};
  const uint64_t size = load<uint32_t>(level + 12);
  if (size != range.count * kRowBytes)
    refuse(index.name(), at + 12, "size", std::to_string(size) + " bytes",
           std::to_string(range.count * kRowBytes) + " of " + std::to_string(range.count) +
               " Gaussians");
  if (range.offset > data_bytes || size > data_bytes - range.offset)
    refuse(index.name(), at + 4, "offset",
           std::to_string(size) + " bytes at " + std::to_string(range.offset),
           "a place in the " + std::to_string(data_bytes) + " bytes of data.bin");
  return range;
}

void require_apart(const ByteSource& index, const std::vector<Range>& ranges) {
  for (size_t i = 1; i < ranges.size(); ++i)
    if (ranges[i].offset < ranges[i - 1].offset + ranges[i - 1].count * kRowBytes)
      refuse(index.name(), 0, "cells",
             "the bytes of data.bin from " + std::to_string(ranges[i].offset) + " twice",
             "each once");
}

}  // namespace

std::vector<Range> finest_level(const ByteSource& index, uint64_t levels, uint64_t data_bytes) {
  const uint64_t cell_bytes = bytes_of_cell(levels);
  if (index.size() == 0 || index.size() % cell_bytes != 0)
    refuse(index.name(), 0, "length", std::to_string(index.size()) + " bytes",
           "a multiple of the " + std::to_string(cell_bytes) + " of a cell, and not 0");
  const std::vector<std::byte> bytes = read_all(index);
  std::vector<Range> ranges;
  for (uint64_t cell = 0; cell < bytes.size(); cell += cell_bytes) {
    Range finest;
    for (uint64_t level = 0; level < levels; ++level) {
      const uint64_t at = cell + kCellNumber + kLevelBytes * level;
      const Range range = range_of(index, bytes.data() + at, at, data_bytes);
      if (finest.count == 0) finest = range;
    }
    if (finest.count != 0) ranges.push_back(finest);
  }
  std::sort(ranges.begin(), ranges.end(),
            [](const Range& a, const Range& b) { return a.offset < b.offset; });
  require_apart(index, ranges);
  return ranges;
}

}  // namespace voyager::lcc
