#pragma once
#include <cuda_runtime_api.h>

namespace voyager::cuda {

inline constexpr unsigned long long kHeadStart = 50'000;  // ns

// Keeps the stream busy for so long, so that the host has launched what follows before the
// device comes to it: events then measure the device's work and not the launches. In a
// frame, the work before it in the stream does the same.
void give_head_start(cudaStream_t stream, unsigned long long nanoseconds = kHeadStart);

}  // namespace voyager::cuda
