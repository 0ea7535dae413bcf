#pragma once
#include <memory>

#include "runtime/frame/backend_module.h"

namespace voyager::cuda {

// Throws Error(no_device) where there is no usable device, or none of that UUID.
std::unique_ptr<Backend> create_cuda_backend(const BackendModuleOptions& options);

}  // namespace voyager::cuda
