#pragma once
#include "RHICommandList.h"

struct FRDGTextureDesc {
  FIntPoint Extent;
  uint8 NumSamples = 1;
};

class FRDGTexture {
 public:
  FRDGTexture(const FRDGTextureDesc& InDesc, FRHITexture* InRHI) : Desc(InDesc), RHI(InRHI) {}
  FRHITexture* GetRHI() const { return RHI; }
  void MarkResourceAsUsed() {}
  const FRDGTextureDesc Desc;

 private:
  FRHITexture* RHI;
};
using FRDGTextureRef = FRDGTexture*;

enum class ERDGPassFlags : uint32 { Raster = 1, SkipRenderPass = 2, NeverCull = 4 };
inline ERDGPassFlags operator|(ERDGPassFlags A, ERDGPassFlags B) {
  return static_cast<ERDGPassFlags>(static_cast<uint32>(A) | static_cast<uint32>(B));
}

// A parameter of a pass: the texture, and the state that it is in while the pass executes.
struct FStubTextureAccess {
  ERHIAccess Access;
  FRDGTextureRef Texture = nullptr;
  void operator=(FRDGTextureRef In) { Texture = In; }
};
#define BEGIN_SHADER_PARAMETER_STRUCT(Name, Prefix) struct Name {
#define RDG_TEXTURE_ACCESS(Name, State) FStubTextureAccess Name{State};
#define END_SHADER_PARAMETER_STRUCT() \
  }                                   \
  ;
#define RDG_EVENT_NAME(Name) Name

class FRDGBuilder {
 public:
  template <class T>
  T* AllocParameters() {
    auto Made = std::make_shared<T>();
    Kept.push_back(Made);
    return Made.get();
  }
  template <class T>
  void AddPass(const char* Name, T* Parameters, ERDGPassFlags,
               TFunction<void(FRHICommandListImmediate&)> Execute) {
    static_assert(sizeof(T) % sizeof(FStubTextureAccess) == 0, "textures only");
    const auto* First = reinterpret_cast<const FStubTextureAccess*>(Parameters);
    StubPasses.push_back({Name, {First, First + sizeof(T) / sizeof *First}, std::move(Execute)});
  }

  struct FStubPass {
    std::string Name;
    std::vector<FStubTextureAccess> Textures;
    TFunction<void(FRHICommandListImmediate&)> Execute;
  };
  std::vector<FStubPass> StubPasses;

 private:
  std::vector<std::shared_ptr<void>> Kept;
};
