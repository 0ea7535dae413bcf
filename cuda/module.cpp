// What libvoyager_cuda.so exports.
#include <algorithm>
#include <cstring>

#include "cuda/cuda_backend.h"
#include "cuda/device.h"
#include "runtime/base/error.h"

namespace voyager::cuda {
namespace {

Backend* create(const BackendModuleOptions& options, ErrorCode* code, char* message, size_t size) {
  std::string what;
  try {
    const std::shared_ptr<void> host_context = keep_context();
    return create_cuda_backend(options).release();
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
  return nullptr;
}

}  // namespace
}  // namespace voyager::cuda

extern "C" __attribute__((visibility("default")))
const voyager::BackendModule voyager_backend_module = {voyager::backend_module_stamp(),
                                                       voyager::cuda::create};
