#include "runtime/frame/backend_module.h"

#include <array>

#include "runtime/base/module.h"

namespace voyager {

const char* backend_module_stamp() {
  static const std::string stamp = module_stamp(sizeof(Scene));
  return stamp.c_str();
}

std::unique_ptr<Backend> load_backend(const std::string& name,
                                      const BackendModuleOptions& options) {
  const auto* module = static_cast<const BackendModule*>(
      open_module(name, kBackendModuleSymbol, backend_module_stamp(), ErrorCode::no_device));
  ErrorCode code = ErrorCode::internal;
  std::array<char, 512> message{};
  if (Backend* backend = module->create(options, &code, message.data(), message.size()))
    return std::unique_ptr<Backend>(backend);
  throw Error(code, message.data());
}

}  // namespace voyager
