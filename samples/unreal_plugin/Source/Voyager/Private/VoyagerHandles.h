#pragma once
// Owners of Voyager's handles. Unreal's modules are built without C++ exceptions, so this module
// calls voyager.h itself and returns errors as text.
#include <voyager/voyager_vulkan.h>

#include "CoreMinimal.h"

template <class HandleType, VoyResult(VOY_CALL* Destroy)(HandleType)>
class TVoyagerHandle {
 public:
  TVoyagerHandle() = default;
  TVoyagerHandle(const TVoyagerHandle&) = delete;
  TVoyagerHandle& operator=(const TVoyagerHandle&) = delete;
  ~TVoyagerHandle() { Reset(); }

  HandleType Get() const { return Handle; }
  // For a function that creates; what was held before is destroyed.
  HandleType* Receive() {
    Reset();
    return &Handle;
  }
  void Reset() {
    Destroy(Handle);
    Handle = nullptr;
  }
  void Swap(TVoyagerHandle& Other) { ::Swap(Handle, Other.Handle); }

 private:
  HandleType Handle = nullptr;
};

using FVoyagerDeviceHandle = TVoyagerHandle<VoyDevice, voyDestroyDevice>;
using FVoyagerSceneHandle = TVoyagerHandle<VoyScene, voyCloseScene>;
using FVoyagerViewHandle = TVoyagerHandle<VoyView, voyDestroyView>;
using FVoyagerTargetHandle = TVoyagerHandle<VoyTarget, voyDestroyTarget>;
using FVoyagerCompositeHandle = TVoyagerHandle<VoyVulkanComposite, voyDestroyVulkanComposite>;

// False, with the library's message in Error, for an error.
inline bool VoyagerSucceeded(VoyResult Result, FString& Error) {
  if (Result >= 0) return true;
  Error = FString(UTF8_TO_TCHAR(voyResultName(Result))) + TEXT(": ") +
          FString(UTF8_TO_TCHAR(voyGetLastErrorMessage()));
  return false;
}
