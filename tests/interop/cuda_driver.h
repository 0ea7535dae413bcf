#pragma once
// What a host that uses CUDA itself sees of its driver, where there is one: nothing is linked.
#include <dlfcn.h>

#include <cstdint>
#include <cstring>
#include <optional>
#include <string>

class CudaDriver {
 public:
  using Context = void*;

  // None where there is no driver or no device; `why` says so.
  static std::optional<CudaDriver> load(std::string& why) {
    void* library = ::dlopen("libcuda.so.1", RTLD_NOW | RTLD_LOCAL);
    why = "no CUDA driver";
    if (library == nullptr) return {};
    CudaDriver driver;
    const bool found = driver.find(library, driver.init, "cuInit") &&
                       driver.find(library, driver.device_count, "cuDeviceGetCount") &&
                       driver.find(library, driver.device_get, "cuDeviceGet") &&
                       driver.find(library, driver.device_uuid, "cuDeviceGetUuid") &&
                       driver.find(library, driver.create, "cuCtxCreate_v2") &&
                       driver.find(library, driver.destroy, "cuCtxDestroy_v2") &&
                       driver.find(library, driver.get_current, "cuCtxGetCurrent") &&
                       driver.find(library, driver.set_current, "cuCtxSetCurrent") &&
                       driver.find(library, driver.memory_info, "cuMemGetInfo_v2");
    int devices = 0;
    if (!found || driver.init(0) != 0) return {};
    why = "no CUDA device";
    if (driver.device_count(&devices) != 0 || devices == 0) return {};
    return driver;
  }

  // A context of the host's own, current to this thread. NULL where there is none with the UUID.
  Context create_on(const uint8_t* uuid) const {
    int devices = 0;
    device_count(&devices);
    for (int i = 0; i < devices; ++i) {
      int device = 0;
      uint8_t found[16] = {};
      Context made = nullptr;
      if (device_get(&device, i) != 0 || device_uuid(found, device) != 0) continue;
      if (uuid != nullptr && std::memcmp(found, uuid, sizeof found) != 0) continue;
      return create(&made, 0, device) == 0 ? made : nullptr;
    }
    return nullptr;
  }
  void destroy_it(Context context) const { destroy(context); }
  Context current() const {
    Context found = nullptr;
    get_current(&found);
    return found;
  }
  void make_current(Context context) const { set_current(context); }
  // Of the current context's device.
  size_t free_bytes() const {
    size_t free = 0, all = 0;
    memory_info(&free, &all);
    return free;
  }

 private:
  template <class Function>
  bool find(void* library, Function& into, const char* name) {
    into = reinterpret_cast<Function>(::dlsym(library, name));
    return into != nullptr;
  }

  int (*init)(unsigned) = nullptr;
  int (*device_count)(int*) = nullptr;
  int (*device_get)(int*, int) = nullptr;
  int (*device_uuid)(uint8_t*, int) = nullptr;
  int (*create)(Context*, unsigned, int) = nullptr;
  int (*destroy)(Context) = nullptr;
  int (*get_current)(Context*) = nullptr;
  int (*set_current)(Context) = nullptr;
  int (*memory_info)(size_t*, size_t*) = nullptr;
};
