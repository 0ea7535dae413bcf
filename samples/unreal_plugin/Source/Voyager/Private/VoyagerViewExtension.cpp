#include "VoyagerViewExtension.h"

#include "FXRenderingUtils.h"
#include "IVulkanDynamicRHI.h"
#include "PostProcess/PostProcessMaterialInputs.h"
#include "RHICommandList.h"
#include "RenderGraphBuilder.h"
#include "RenderGraphUtils.h"
#include "SceneView.h"
#include "ScreenPass.h"

BEGIN_SHADER_PARAMETER_STRUCT(FVoyagerPassParameters, )
RDG_TEXTURE_ACCESS(Color, ERHIAccess::CopyDest)
RDG_TEXTURE_ACCESS(Depth, ERHIAccess::CopyDest)
END_SHADER_PARAMETER_STRUCT()

namespace {

FRDGTextureRef SceneDepth(const FPostProcessMaterialInputs& Inputs) {
  return Inputs.SceneTextures.SceneTextures
             ? Inputs.SceneTextures.SceneTextures->GetContents()->SceneDepthTexture
             : nullptr;
}

// What is missing for splats that meshes hide; empty if nothing is.
FString FindObstacle(const FScreenPassTexture& Color, FRDGTextureRef Depth, const FIntRect& Scene) {
  if (!Color.IsValid() || !Depth)
    return TEXT("found no colour or no depth after tonemapping, expected both");
  if (Color.ViewRect != Scene)
    return FString::Printf(
        TEXT("found a scene of %d x %d pixels in a picture of %d x %d, expected the same size and "
             "place (r.ScreenPercentage 100, no temporal upscaling)"),
        Scene.Width(), Scene.Height(), Color.ViewRect.Width(), Color.ViewRect.Height());
  if (Color.Texture->Desc.NumSamples != 1 || Depth->Desc.NumSamples != 1)
    return FString::Printf(TEXT("found %d samples of colour and %d of depth, expected 1"),
                           static_cast<int32>(Color.Texture->Desc.NumSamples),
                           static_cast<int32>(Depth->Desc.NumSamples));
  return FString();
}

void AddVoyagerPass(FRDGBuilder& GraphBuilder, const FVoyagerViewFrame& Frame, FRDGTextureRef Color,
                    FRDGTextureRef Depth, const TSharedPtr<FVoyagerRenderer>& Renderer,
                    const TSharedPtr<FVoyagerErrors>& Errors) {
  FVoyagerPassParameters* Parameters = GraphBuilder.AllocParameters<FVoyagerPassParameters>();
  Parameters->Color = Color;
  Parameters->Depth = Depth;
  GraphBuilder.AddPass(
      RDG_EVENT_NAME("Voyager"), Parameters,
      ERDGPassFlags::Raster | ERDGPassFlags::SkipRenderPass | ERDGPassFlags::NeverCull,
      [Frame, Color, Depth, Renderer, Errors](FRHICommandListImmediate& RHICmdList) {
        Color->MarkResourceAsUsed();
        Depth->MarkResourceAsUsed();
        const FGPUFenceRHIRef Fence = RHICreateGPUFence(TEXT("Voyager"));
        RHICmdList.EnqueueLambda([Frame, Renderer, Errors, Fence, Colors = Color->GetRHI(),
                                  Depths = Depth->GetRHI()](FRHICommandListImmediate& Executing) {
          IVulkanDynamicRHI* RHI = GetIVulkanDynamicRHI();
          const VkCommandBuffer Commands = GetVoyagerCommandBuffer(Executing);
          FString Error;
          if (!Renderer->Draw(Commands, Frame, RHI->RHIGetImageViewInfo(Colors),
                              RHI->RHIGetImageViewInfo(Depths), Fence, Error))
            Errors->Report(Error);
          RHI->RHIFinishExternalComputeWork(Commands);  // pipelines and descriptors have changed
        });
        RHICmdList.WriteGPUFence(Fence);
      });
}

}  // namespace

void FVoyagerViewExtension::SubscribeToPostProcessingPass(
    EPostProcessingPass Pass, const FSceneView&, FAfterPassCallbackDelegateArray& Callbacks, bool) {
  if (Pass == EPostProcessingPass::Tonemap)
    Callbacks.Add(
        FAfterPassCallbackDelegate::CreateRaw(this, &FVoyagerViewExtension::Draw_RenderThread));
}

FScreenPassTexture FVoyagerViewExtension::Draw_RenderThread(
    FRDGBuilder& GraphBuilder, const FSceneView& View, const FPostProcessMaterialInputs& Inputs) {
  FScreenPassTexture Color = FScreenPassTexture::CopyFromSlice(
      GraphBuilder, Inputs.GetInput(EPostProcessMaterialInput::SceneColor));
  if (Inputs.OverrideOutput.IsValid()) {  // the last pass: its output must hold the picture
    AddDrawTexturePass(GraphBuilder, View, Color, Inputs.OverrideOutput);
    Color = Inputs.OverrideOutput;
  }
  const FRDGTextureRef Depth = SceneDepth(Inputs);
  const FString Obstacle =
      FindObstacle(Color, Depth, UE::FXRenderingUtils::GetRawViewRectUnsafe(View));
  if (!Obstacle.IsEmpty()) {
    Errors->Report(Obstacle);
    return Color;
  }
  const FViewMatrices& Matrices = View.ViewMatrices;
  AddVoyagerPass(GraphBuilder,
                 {Matrices.GetViewOrigin(), Matrices.GetInvViewMatrix(),
                  Matrices.GetProjectionNoAAMatrix(), Color.ViewRect},
                 Color.Texture, Depth, Renderer, Errors);
  return Color;
}
