// What libvoyager_cuda.so exports.
#include <algorithm>
#include <cstring>

#include "cuda/cuda_backend.h"
#include "cuda/device/device.h"
#include "cuda/device/machine.h"
#include "runtime/base/error.h"

namespace voyager::cuda {
namespace {

// Runs `work`; what it throws becomes *code and a terminated message. True if nothing was thrown.
template <class Work>
bool reported(const Work& work, ErrorCode* code, char* message, size_t size) {
  std::string what;
  try {
    work();
    return true;
  } catch (const Error& error) {
    *code = error.code();
    what = error.what();
  } catch (const std::exception& error) {
    *code = ErrorCode::internal;
    what = error.what();
  }
  const size_t length = std::min(size - 1, what.size());
  std::memcpy(message, what.data(), length);
  message[length] = '\0';
  return false;
}

Backend* create(const BackendModuleOptions& options, ErrorCode* code, char* message, size_t size) {
  Backend* backend = nullptr;
  reported(
      [&] {
        require_driver_and_device();
        const std::shared_ptr<void> host_context = keep_context();
        backend = create_cuda_backend(options).release();
      },
      code, message, size);
  return backend;
}

bool list(std::vector<BackendDevice>& devices, ErrorCode* code, char* message, size_t size) {
  return reported([&] { devices = list_devices(); }, code, message, size);
}

}  // namespace
}  // namespace voyager::cuda

extern "C" __attribute__((visibility("default")))
const voyager::BackendModule voyager_backend_module = {voyager::backend_module_stamp(),
                                                       voyager::cuda::create, voyager::cuda::list};
