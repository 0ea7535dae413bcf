#pragma once
#include "RenderGraphBuilder.h"

class FSceneView;

struct FScreenPassTexture;
struct FScreenPassTextureSlice {
  FRDGTextureRef StubTexture = nullptr;
  FIntRect ViewRect;
};

struct FScreenPassTexture {
  FScreenPassTexture() = default;
  FScreenPassTexture(FRDGTextureRef InTexture, const FIntRect& InRect)
      : Texture(InTexture), ViewRect(InRect) {}
  bool IsValid() const { return Texture != nullptr; }
  static FScreenPassTexture CopyFromSlice(FRDGBuilder&, const FScreenPassTextureSlice& Slice) {
    return {Slice.StubTexture, Slice.ViewRect};
  }

  FRDGTextureRef Texture = nullptr;
  FIntRect ViewRect;
};

struct FScreenPassRenderTarget : FScreenPassTexture {
  using FScreenPassTexture::FScreenPassTexture;
};

void AddDrawTexturePass(FRDGBuilder& GraphBuilder, const FSceneView& View, FScreenPassTexture Input,
                        FScreenPassRenderTarget Output);
