#pragma once
// Shared memory of a device's multiprocessors.
#include <algorithm>
#include <cstddef>

namespace voyager::cuda {

// As the driver tells it; bytes.
struct SharedMemory {
  int of_multiprocessor, reserved_of_block, most_of_block;
};

// What a block may have where so many are to be resident on a multiprocessor.
constexpr size_t bytes_of_block(const SharedMemory& memory, unsigned blocks) {
  const int share = memory.of_multiprocessor / static_cast<int>(blocks) - memory.reserved_of_block;
  return static_cast<size_t>(std::min(share, memory.most_of_block));
}

}  // namespace voyager::cuda
