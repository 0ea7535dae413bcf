#pragma once
#include "CoreMinimal.h"

enum class ERHIInterfaceType { D3D12, Vulkan };
enum class ERHIAccess { CopyDest };

class FDynamicRHI {
 public:
  virtual ~FDynamicRHI() = default;
  virtual ERHIInterfaceType GetInterfaceType() const = 0;
};
extern FDynamicRHI* GDynamicRHI;

class FRHITexture;

class FRHIGPUFence {
 public:
  virtual ~FRHIGPUFence() = default;
  virtual bool Poll() const = 0;
};

template <class T>
class TRefCountPtr {
 public:
  TRefCountPtr() = default;
  explicit TRefCountPtr(std::shared_ptr<T> In) : Pointer(std::move(In)) {}
  bool IsValid() const { return Pointer != nullptr; }
  T* operator->() const { return Pointer.get(); }
  T* GetReference() const { return Pointer.get(); }

 private:
  std::shared_ptr<T> Pointer;
};
using FGPUFenceRHIRef = TRefCountPtr<FRHIGPUFence>;
FGPUFenceRHIRef RHICreateGPUFence(const TCHAR* Name);
