#pragma once
// The plugin as a host loads it: dlopen, and each entry point by name.
#include <dlfcn.h>
#include <gtest/gtest.h>

#include <voyager/voyager.h>

#include <fstream>
#include <string>

// clang-format off
#define VOYAGER_ENTRY_POINTS(X) \
  X(GetVersion) X(ResultName) X(GetLastErrorMessage) X(QueryBackend) \
  X(CreateDevice) X(DestroyDevice) X(GetCapabilities) X(OpenScene) \
  X(CloseScene) X(GetSceneInfo) X(GetSceneNotes) X(CreateTarget) \
  X(DestroyTarget) X(CreateView) X(DestroyView) X(SetViewTau) X(SetViewTimeBudget) \
  X(SetViewInstances) \
  X(FrustumFromAngles) X(FrustumFromIntrinsics) X(FrustumFromProjection) \
  X(PoseFromWorldMatrix) X(PoseFromViewMatrix) X(RenderFrame) X(GetViewCut) \
  X(GetFrameStats) X(StageName) X(SetSceneMemoryBudget) X(GetStreamingStats) \
  X(GetViewOmissions) X(EnumerateDevices)
// clang-format on

class Library {
 public:
  explicit Library(const char* file = VOYAGER_LIBRARY)
      : handle_(dlopen(file, RTLD_NOW | RTLD_LOCAL)) {
    if (handle_ == nullptr) {
      ADD_FAILURE() << dlerror();
      return;
    }
#define VOYAGER_FIND(name) name = find<decltype(name)>("voy" #name);
    VOYAGER_ENTRY_POINTS(VOYAGER_FIND)
#undef VOYAGER_FIND
  }
  ~Library() {
    if (handle_ != nullptr) dlclose(handle_);
  }
  Library(const Library&) = delete;
  Library& operator=(const Library&) = delete;

#define VOYAGER_DECLARE(name) decltype(&::voy##name) name = nullptr;
  VOYAGER_ENTRY_POINTS(VOYAGER_DECLARE)
#undef VOYAGER_DECLARE

  std::string message() const {
    return GetLastErrorMessage();
  }

  // Whether any libvoyager is mapped into this process.
  static bool is_mapped() {
    std::ifstream maps("/proc/self/maps");
    for (std::string line; std::getline(maps, line);)
      if (line.find("libvoyager.so") != std::string::npos) return true;
    return false;
  }

  template <class Function>
  Function find(const char* name) {
    void* symbol = dlsym(handle_, name);
    EXPECT_NE(symbol, nullptr) << name;
    return reinterpret_cast<Function>(symbol);
  }

 private:
  void* handle_;
};
