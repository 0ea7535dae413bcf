#include "runtime/frame/backend_module.h"

#include <array>

#include "runtime/base/module.h"

namespace voyager {
namespace {

const BackendModule& module_of(const std::string& name) {
  try {
    return *static_cast<const BackendModule*>(
        open_module(name, kBackendModuleSymbol, backend_module_stamp(), ErrorCode::no_device));
  } catch (const Error& error) {
    throw Error(error.code(), std::string(error.what()) +
                                  ". Without an NVIDIA GPU it is not needed; for one, install the "
                                  "CUDA module beside libvoyager.so, or build where nvcc is found");
  }
}

}  // namespace

const char* backend_module_stamp() {
  static const std::string stamp = module_stamp(sizeof(Scene) + sizeof(BackendModule));
  return stamp.c_str();
}

std::unique_ptr<Backend> load_backend(const std::string& name,
                                      const BackendModuleOptions& options) {
  const BackendModule& module = module_of(name);
  ErrorCode code = ErrorCode::internal;
  std::array<char, 512> message{};
  if (Backend* backend = module.create(options, &code, message.data(), message.size()))
    return std::unique_ptr<Backend>(backend);
  throw Error(code, message.data());
}

std::vector<BackendDevice> list_backend(const std::string& name) {
  const BackendModule& module = module_of(name);
  std::vector<BackendDevice> devices;
  ErrorCode code = ErrorCode::internal;
  std::array<char, 512> message{};
  if (module.list(devices, &code, message.data(), message.size())) return devices;
  throw Error(code, message.data());
}

}  // namespace voyager
