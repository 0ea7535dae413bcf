#pragma once
// The one place where kernels are launched: none goes without its check.
#include <utility>

#include "cuda/device/check.h"

namespace voyager::cuda {

struct Grid {
  dim3 blocks;
  unsigned threads;  // of a block
  cudaStream_t stream;
  size_t shared_bytes = 0;  // of a block, dynamic
};

// Throws Error where the kernel does not start; `name` is the kernel's in its message.
template <class... Parameters, class... Arguments>
void launch_kernel(const char* name, void (*kernel)(Parameters...), const Grid& grid,
                   Arguments&&... arguments) {
  kernel<<<grid.blocks, grid.threads, grid.shared_bytes, grid.stream>>>(
      std::forward<Arguments>(arguments)...);
  check(cudaGetLastError(), name);
}

}  // namespace voyager::cuda
