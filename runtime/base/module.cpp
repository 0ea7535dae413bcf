#include "runtime/base/module.h"

#include <dlfcn.h>

#include <array>
#include <filesystem>

namespace voyager {
namespace {

// Where the code of this very function was loaded from.
std::filesystem::path own_folder() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&module_stamp), &info) == 0 || !info.dli_fname)
    return {};
  std::error_code ignored;
  return std::filesystem::absolute(info.dli_fname, ignored).lexically_normal().parent_path();
}

// `why` is the reason of the first that is there and cannot be loaded: a module beside the library
// that lacks a library of its own says so.
void* open_library(const std::string& file, std::string& why) {
  const std::filesystem::path own = own_folder();
  const std::array<std::filesystem::path, 2> folders = {own,
                                                        (own / ".." / "lib").lexically_normal()};
  for (const std::filesystem::path& folder : folders) {
    const std::string place = (folder / file).string();
    std::error_code ignored;
    if (!std::filesystem::exists(place, ignored)) continue;
    if (void* library = dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE))
      return library;
    if (why.empty()) why = "cannot be loaded: " + std::string(dlerror());
  }
  if (void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE)) return library;
  if (why.empty())
    why = "not found in " + own.string() +
          (folders[1] == own ? "" : ", in " + folders[1].string()) +
          ", or where the system looks for libraries";
  return nullptr;
}

}  // namespace

std::string module_stamp(size_t shared_type_bytes) {
  // Raised with each change of a class that modules share and whose size does not change with it,
  // such as a virtual function of ByteSource.
  constexpr int kSharedClasses = 2;
  return std::string(VOYAGER_VERSION) + ", " + __VERSION__ + ", " +
         std::to_string(shared_type_bytes) + ", " + std::to_string(kSharedClasses);
}

const void* open_module(const std::string& name, const char* symbol, const std::string& stamp,
                        ErrorCode failure) {
  const std::string file = "libvoyager_" + name + ".so";
  std::string why;
  void* library = open_library(file, why);
  if (!library) throw Error(failure, file + ": " + why);
  const void* module = dlsym(library, symbol);
  const char* found = module ? *static_cast<const char* const*>(module) : "no known build";
  if (stamp != found)
    throw Error(failure, file + ": found a module of " + found + ", expected " + stamp +
                             ": install both from one build");
  return module;
}

}  // namespace voyager
