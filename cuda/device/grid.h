#pragma once
#include <cuda_runtime_api.h>

#include <algorithm>
#include <array>
#include <atomic>

#include "cuda/device/check.h"

namespace voyager::cuda {

// Thread blocks of a kernel that are resident on a multiprocessor at once: its loops share the
// work out, and a second wave would find none left. Of the current device, asked for once: a host
// may draw on several devices, of which each has its own number. Any thread. Throws Error.
template <auto kKernel>
unsigned resident_blocks(int threads) {
  constexpr size_t kKnownDevices = 32;
  static std::array<std::atomic<unsigned>, kKnownDevices> known{};
  int device = 0;
  check(cudaGetDevice(&device), "device");
  const auto index = static_cast<size_t>(device);
  if (index < kKnownDevices)
    if (const unsigned blocks = known[index].load(std::memory_order_relaxed); blocks != 0)
      return blocks;
  int blocks = 0;
  check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kKernel, threads, 0), "occupancy");
  if (index < kKnownDevices)
    known[index].store(static_cast<unsigned>(blocks), std::memory_order_relaxed);
  return static_cast<unsigned>(blocks);
}

// Shared memory that a block may have on every device that is supported: what those of compute
// capability 8.6 and 8.9 give, the least.
inline constexpr size_t kLeastSharedBytes = size_t{99} << 10;

// Shared memory that a block may have where so many are to be resident on a multiprocessor of the
// current device.
inline size_t shared_bytes_of_block(unsigned blocks) {
  int device = 0, all = 0, reserved = 0, most = 0;
  check(cudaGetDevice(&device), "device");
  const auto ask = [device](int& value, cudaDeviceAttr attribute) {
    check(cudaDeviceGetAttribute(&value, attribute, device), "device attribute");
  };
  ask(all, cudaDevAttrMaxSharedMemoryPerMultiprocessor);
  ask(reserved, cudaDevAttrReservedSharedMemoryPerBlock);
  ask(most, cudaDevAttrMaxSharedMemoryPerBlockOptin);
  return static_cast<size_t>(std::min(all / static_cast<int>(blocks) - reserved, most));
}

// Before a launch with up to so much dynamic shared memory. Of the context, of which a process may
// have several, so that it is said each time. Threads launch at once: of one kernel on one device
// it must be the same each time, or one thread's launch would have the room of another's.
template <class Kernel>
void allow_shared_bytes(Kernel kernel, int bytes, const char* what) {
  check(cudaFuncSetAttribute(kernel, cudaFuncAttributeMaxDynamicSharedMemorySize, bytes), what);
}

}  // namespace voyager::cuda
