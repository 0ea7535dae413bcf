#pragma once
// The one place where CUDA's errors become ours.
#include <cuda_runtime_api.h>

namespace voyager::cuda {

// Throws Error: over_budget for want of device memory, no_device where there is no
// usable device, device_lost where its context can do nothing any more, else internal; the message
// has `what` and CUDA's own words.
void check(cudaError_t status, const char* what);
// The same for what starts a device up. The message also says what the user can do.
void check_start(cudaError_t status, const char* what);

}  // namespace voyager::cuda
