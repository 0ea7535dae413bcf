#pragma once
#include "CoreMinimal.h"
#include "ScreenPass.h"

class FSceneView;
struct FPostProcessMaterialInputs;

struct FAfterPassCallbackDelegate {
  using FFunction = TFunction<FScreenPassTexture(FRDGBuilder&, const FSceneView&,
                                                 const FPostProcessMaterialInputs&)>;
  template <class T>
  static FAfterPassCallbackDelegate CreateRaw(
      T* Object, FScreenPassTexture (T::*Function)(FRDGBuilder&, const FSceneView&,
                                                   const FPostProcessMaterialInputs&)) {
    return {[Object, Function](FRDGBuilder& Builder, const FSceneView& View,
                               const FPostProcessMaterialInputs& Inputs) {
      return (Object->*Function)(Builder, View, Inputs);
    }};
  }
  FFunction Execute;
};
using FAfterPassCallbackDelegateArray = TArray<FAfterPassCallbackDelegate>;

class ISceneViewExtension {
 public:
  enum class EPostProcessingPass : uint32 { MotionBlur, Tonemap, FXAA };
  virtual ~ISceneViewExtension() = default;
  virtual void SubscribeToPostProcessingPass(EPostProcessingPass Pass, const FSceneView& InView,
                                             FAfterPassCallbackDelegateArray& InOutPassCallbacks,
                                             bool bIsPassEnabled) = 0;
};

class FAutoRegister {};

class FSceneViewExtensionBase : public ISceneViewExtension {
 public:
  FSceneViewExtensionBase(const FAutoRegister&) {}
};

class FSceneViewExtensions {
 public:
  template <class T, class... Args>
  static TSharedRef<T> NewExtension(Args&&... Values) {
    TSharedRef<T> Made = MakeShared<T>(FAutoRegister(), std::forward<Args>(Values)...);
    StubExtensions.push_back(Made.StubWeak());
    return Made;
  }
  static inline std::vector<std::weak_ptr<ISceneViewExtension>> StubExtensions;
};
