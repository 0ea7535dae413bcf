#pragma once
#include <cuda_runtime_api.h>

namespace voyager::cuda {

// Keeps the stream busy for 50 µs, so that the host has launched what follows before the
// device comes to it: events then measure the device's work and not the launches. In a
// frame, the work before it in the stream does the same.
void give_head_start(cudaStream_t stream);

}  // namespace voyager::cuda
