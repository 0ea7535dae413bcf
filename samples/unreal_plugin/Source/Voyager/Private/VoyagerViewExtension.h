#pragma once
// Draws the splats into each view of the engine, after tonemapping: Voyager's colours are code
// values, which must not be tonemapped again.
#include "SceneViewExtension.h"
#include "VoyagerErrors.h"
#include "VoyagerRenderer.h"

class FVoyagerViewExtension : public FSceneViewExtensionBase {
 public:
  FVoyagerViewExtension(const FAutoRegister& AutoRegister,
                        const TSharedPtr<FVoyagerRenderer>& InRenderer,
                        const TSharedPtr<FVoyagerErrors>& InErrors)
      : FSceneViewExtensionBase(AutoRegister), Renderer(InRenderer), Errors(InErrors) {}

  void SubscribeToPostProcessingPass(EPostProcessingPass Pass, const FSceneView& View,
                                     FAfterPassCallbackDelegateArray& Callbacks,
                                     bool bIsPassEnabled) override;

 private:
  FScreenPassTexture Draw_RenderThread(FRDGBuilder& GraphBuilder, const FSceneView& View,
                                       const FPostProcessMaterialInputs& Inputs);

  TSharedPtr<FVoyagerRenderer> Renderer;
  TSharedPtr<FVoyagerErrors> Errors;
};
