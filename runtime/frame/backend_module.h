#pragma once
// Backends that live in a module (runtime/base/module.h).
#include <array>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "runtime/base/error.h"
#include "runtime/frame/backend.h"

namespace voyager {

struct BackendModuleOptions {
  int device = 0;                 // the driver's number
  unsigned multiprocessors = 0;   // 0: all, else a part of them
  const uint8_t* uuid = nullptr;  // 16 bytes: the device that has it, instead of `device`
};

// A device as its driver describes it. No work was started on it.
struct BackendDevice {
  std::string name;
  std::array<uint8_t, 16> uuid{};
  uint32_t capability[2] = {0, 0};  // CUDA: compute capability, major and minor
  uint64_t memory_bytes = 0;
  uint32_t cuda_version = 0;  // that the driver supports: 1000 * major + 10 * minor
  std::string driver;         // its release, "" where that is not known
  std::string missing;        // why the module cannot use it, and what to do; "" where it can
};

// What a module exports as voyager_backend_module. The two sides share C++ types, so
// they must come from one build; stamp (version, compiler, a size) tells most others.
struct BackendModule {
  const char* stamp;
  // Null on failure, with *code and a terminated message of at most `size` bytes.
  Backend* (*create)(const BackendModuleOptions& options, ErrorCode* code, char* message,
                     size_t size);
  // False on failure, as create.
  bool (*list)(std::vector<BackendDevice>& devices, ErrorCode* code, char* message, size_t size);
};

// The oldest NVIDIA GPUs that the CUDA module draws on (cmake/cuda.cmake compiles for these).
inline constexpr uint32_t kLeastComputeCapability = 8;

inline constexpr char kBackendModuleSymbol[] = "voyager_backend_module";

// This build's stamp.
const char* backend_module_stamp();

// Loads libvoyager_NAME.so. It stays loaded: the driver's run-time does not survive being
// unloaded. Thread-safe. Throws
// Error(no_device) where there is no module, or one of another build, or it finds no
// device, with the reason and what to do.
std::unique_ptr<Backend> load_backend(const std::string& name, const BackendModuleOptions& options);

// At least one device, in the driver's order. Throws as load_backend() does.
std::vector<BackendDevice> list_backend(const std::string& name);

}  // namespace voyager
