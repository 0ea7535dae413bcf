#pragma once
#include <cuda_runtime_api.h>

#include "cuda/device/check.h"
#include "cuda/device/per_device.h"
#include "cuda/device/shared_memory.h"

namespace voyager::cuda {

// Thread blocks of so many threads that are resident on a multiprocessor at once, for a kernel with
// no or little dynamic shared memory: its loops share the work out, and a second wave would find
// none left. Of the current device. Any thread. Throws Error.
template <auto kKernel, int kThreads>
unsigned resident_blocks() {
  static PerDevice<unsigned> known;
  int device = 0;
  check(cudaGetDevice(&device), "device");
  return known.of(device, [] {
    int blocks = 0;
    check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kKernel, kThreads, 0),
          "occupancy");
    return static_cast<unsigned>(blocks);
  });
}

// Shared memory that a block may have on every device that is supported: what those of compute
// capability 8.6 and 8.9 give, the least.
inline constexpr size_t kLeastSharedBytes = size_t{99} << 10;

// As bytes_of_block(), of the current device.
inline size_t shared_bytes_of_block(unsigned blocks) {
  int device = 0;
  SharedMemory memory{};
  check(cudaGetDevice(&device), "device");
  const auto ask = [device](int& value, cudaDeviceAttr attribute) {
    check(cudaDeviceGetAttribute(&value, attribute, device), "device attribute");
  };
  ask(memory.of_multiprocessor, cudaDevAttrMaxSharedMemoryPerMultiprocessor);
  ask(memory.reserved_of_block, cudaDevAttrReservedSharedMemoryPerBlock);
  ask(memory.most_of_block, cudaDevAttrMaxSharedMemoryPerBlockOptin);
  return bytes_of_block(memory, blocks);
}

// Before a launch with up to so much dynamic shared memory. Of the context, of which a process may
// have several, so that it is said each time. Threads launch at once: of one kernel on one device
// it must be the same each time, or one thread's launch would have the room of another's.
template <class Kernel>
void allow_shared_bytes(Kernel kernel, size_t bytes, const char* what) {
  check(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize,
                             static_cast<int>(bytes)),
        what);
}

}  // namespace voyager::cuda
