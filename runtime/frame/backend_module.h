#pragma once
// Backends that live in a module (runtime/base/module.h).
#include <cstddef>
#include <memory>
#include <string>

#include "runtime/base/error.h"
#include "runtime/frame/backend.h"

namespace voyager {

struct BackendModuleOptions {
  int device = 0;                 // the driver's number
  unsigned multiprocessors = 0;   // 0: all, else a part of them
  const uint8_t* uuid = nullptr;  // 16 bytes: the device that has it, instead of `device`
};

// What a module exports as voyager_backend_module. The two sides share C++ types, so
// they must come from one build; stamp (version, compiler, a size) tells most others.
struct BackendModule {
  const char* stamp;
  // Null on failure, with *code and a terminated message of at most `size` bytes.
  Backend* (*create)(const BackendModuleOptions& options, ErrorCode* code, char* message,
                     size_t size);
};

inline constexpr char kBackendModuleSymbol[] = "voyager_backend_module";

// This build's stamp.
const char* backend_module_stamp();

// Loads libvoyager_NAME.so. It stays loaded: the driver's run-time does not survive being
// unloaded. Thread-safe. Throws
// Error(no_device) where there is no module, or one of another build, or it finds no
// device, with the reason.
std::unique_ptr<Backend> load_backend(const std::string& name, const BackendModuleOptions& options);

}  // namespace voyager
