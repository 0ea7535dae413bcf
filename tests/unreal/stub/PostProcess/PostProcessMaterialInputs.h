#pragma once
#include "ScreenPass.h"

struct FSceneTextureUniformParameters {
  FRDGTextureRef SceneDepthTexture = nullptr;
};
struct FStubSceneTextureBuffer {
  FSceneTextureUniformParameters Contents;
  const FSceneTextureUniformParameters* GetContents() const { return &Contents; }
};
struct FSceneTextureShaderParameters {
  const FStubSceneTextureBuffer* SceneTextures = nullptr;
};

enum class EPostProcessMaterialInput { SceneColor };

struct FPostProcessMaterialInputs {
  FScreenPassTextureSlice GetInput(EPostProcessMaterialInput) const { return StubColor; }

  FScreenPassTextureSlice StubColor;
  FScreenPassRenderTarget OverrideOutput;
  FSceneTextureShaderParameters SceneTextures;
};
