#pragma once
#include <cuda_runtime_api.h>

#include "cuda/check.h"

namespace voyager::cuda {

// Thread blocks of a kernel that are resident at once: its loops share the work out, and
// a second wave would find none left.
template <class Kernel>
unsigned resident_blocks(Kernel kernel, int threads, unsigned multiprocessors) {
  int blocks = 0;
  check(cudaOccupancyMaxActiveBlocksPerMultiprocessor(&blocks, kernel, threads, 0), "occupancy");
  return multiprocessors * static_cast<unsigned>(blocks);
}

}  // namespace voyager::cuda
