#include "runtime/frame/backend_module.h"

#include <dlfcn.h>

#include <array>
#include <filesystem>
#include <vector>

namespace voyager {
namespace {

// Where the code of this very function was loaded from.
std::filesystem::path own_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&backend_module_stamp), &info) == 0 || !info.dli_fname)
    return {};
  std::error_code ignored;
  return std::filesystem::absolute(info.dli_fname, ignored).parent_path();
}

void* open_library(const std::string& file, std::string& why) {
  const std::filesystem::path folder = own_folder();
  const std::vector<std::string> places = {(folder / file).string(),
                                           (folder / ".." / "lib" / file).string(), file};
  for (const std::string& place : places) {
    std::error_code ignored;
    if (place != file && !std::filesystem::exists(place, ignored)) continue;
    if (void* library = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE))
      return library;
    why = dlerror();
  }
  return nullptr;
}

}  // namespace

const char* backend_module_stamp() {
  static const std::string stamp =
      std::string(VOYAGER_VERSION) + ", " + __VERSION__ + ", " + std::to_string(sizeof(Scene));
  return stamp.c_str();
}

std::unique_ptr<Backend> load_backend(const std::string& name,
                                      const BackendModuleOptions& options) {
  const std::string file = "libvoyager_" + name + ".so";
  std::string why;
  void* library = open_library(file, why);
  if (!library) throw Error(ErrorCode::no_device, file + ": cannot be loaded: " + why);
  const auto* module = static_cast<const BackendModule*>(dlsym(library, kBackendModuleSymbol));
  if (!module || std::string(module->stamp) != backend_module_stamp())
    throw Error(ErrorCode::no_device, file + ": found a module of " +
                                          (module ? module->stamp : "no known build") +
                                          ", expected " + backend_module_stamp());
  ErrorCode code = ErrorCode::internal;
  std::array<char, 512> message{};
  if (Backend* backend = module->create(options, &code, message.data(), message.size()))
    return std::unique_ptr<Backend>(backend);
  throw Error(code, message.data());
}

}  // namespace voyager
