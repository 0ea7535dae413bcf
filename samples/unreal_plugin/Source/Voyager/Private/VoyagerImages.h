#pragma once
// The images that Voyager draws into, of one size. Unreal's submissions take no semaphores from
// plugins, so a fence of Unreal's tells when the GPU has finished with an image:
//   1. Acquire() draws an image that is free and records its hand-over to Unreal
//   2. the composite is recorded
//   3. Release() records the hand-over back; the image is free when the fence has passed
#include "CoreMinimal.h"
#include "RHI.h"
#include "VoyagerHandles.h"

class FVoyagerImages {
 public:
  static TSharedPtr<FVoyagerImages> Create(VoyDevice Device, const FIntPoint& Size,
                                           uint32 QueueFamily, FString& Error);

  const FIntPoint& GetSize() const { return Size; }
  VoyTarget GetTarget() const { return Target.Get(); }

  // The hand-over of all images to Voyager, once, before the first frame.
  bool ReleaseAll(VkCommandBuffer Commands, const FGPUFenceRHIRef& Fence, FString& Error);
  // Draws into an image and returns its index. INDEX_NONE without an error where the GPU still
  // uses all of them, and with one where the frame failed.
  int32 Acquire(VkCommandBuffer Commands, VoyView View, const VoyFrameEye& Eye, double NearZ,
                FString& Error);
  bool Release(VkCommandBuffer Commands, int32 Image, const FGPUFenceRHIRef& Fence, FString& Error);

 private:
  static constexpr int32 kImages = 4;  // more than Unreal has frames in flight
  VoyVulkanUse Use(VkCommandBuffer Commands, int32 Image) const;

  FIntPoint Size;
  uint32 QueueFamily = 0;
  FVoyagerTargetHandle Target;
  FGPUFenceRHIRef Fences[kImages];  // of the commands that used the image last
};
