#pragma once
#include <memory>
#include <string>

#include "runtime/frame/backend.h"
#include "voyager/voyager.h"

namespace voyager {

struct BackendChoice {
  VoyBackend kind = VOY_BACKEND_CPU;
  std::unique_ptr<Backend> backend;
  std::string cuda_left_out = {};  // why AUTO is not CUDA, where that was tried
};

// uuid: 16 bytes, or NULL for any device (voyager.h, VoyDeviceDesc.deviceUuid). For CUDA
// and AUTO this loads the module, which stays. Throws Error(no_device), but never for AUTO.
BackendChoice choose_backend(VoyBackend wanted, const uint8_t* uuid);

}  // namespace voyager
