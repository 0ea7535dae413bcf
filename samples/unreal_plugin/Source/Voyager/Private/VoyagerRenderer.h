#pragma once
// Voyager on Unreal's device: from the first scene until the engine exits.
#include "CoreMinimal.h"
#include "IVulkanDynamicRHI.h"
#include "Misc/ScopeLock.h"
#include "VoyagerComposite.h"
#include "VoyagerHandles.h"
#include "VoyagerImages.h"
#include "VoyagerVulkan.h"

// What a view of Unreal's draws.
struct FVoyagerViewFrame {
  FVector Eye;
  FMatrix ViewToWorld, Projection;  // as MakeVoyagerCamera takes them
  FIntRect Area;                    // of the textures
};

class FVoyagerRenderer {
 public:
  // NULL with an error. On the game thread.
  static TSharedPtr<FVoyagerRenderer> Create(FString& Error);
  // While Unreal's device exists. Waits until the GPU is idle.
  ~FVoyagerRenderer();

  // On any thread. Blocks until the scene is open and replaces the one before it.
  bool OpenScene(const FString& Path, const FVector& Origin, FString& Error);
  void CloseScene();

  // Where Unreal executes its commands: the RHI thread. Both textures are in TRANSFER_DST_OPTIMAL
  // and stay so. Fence is written after these commands. An area of a new size gets its first
  // splats in the frame after. False with an error; then the frame lacks the splats.
  bool Draw(VkCommandBuffer Commands, const FVoyagerViewFrame& Frame,
            const FVulkanRHIImageViewInfo& Color, const FVulkanRHIImageViewInfo& Depth,
            const FGPUFenceRHIRef& Fence, FString& Error);

 private:
  bool FitComposite(VkFormat Color, VkFormat Depth, FString& Error);
  bool FitView(const FIntPoint& Size, FString& Error);
  bool FitImages(VkCommandBuffer Commands, const FIntPoint& Size, const FGPUFenceRHIRef& Fence,
                 bool& bNew, FString& Error);
  void FreeRetired();

  const FVoyagerVulkanFunctions Functions;
  FVoyagerDeviceHandle Device;
  FCriticalSection Mutex;  // what follows
  FVoyagerSceneHandle Scene;
  FVector Origin = FVector(0, 0, 0);
  FVoyagerViewHandle View;
  FIntPoint ViewSize = FIntPoint(0, 0);
  TSharedPtr<FVoyagerImages> Images;
  TSharedPtr<FVoyagerComposite> Composite;
  FGPUFenceRHIRef LastFence;  // of the last frame that was recorded

  // What the GPU may still use until the fence has passed.
  struct FRetired {
    FGPUFenceRHIRef Fence;
    TSharedPtr<FVoyagerAttachments> Attachments;
    TSharedPtr<FVoyagerImages> Images;
    TSharedPtr<FVoyagerComposite> Composite;
  };
  TArray<FRetired> Retired;
};
