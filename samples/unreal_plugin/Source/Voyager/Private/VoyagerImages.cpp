#include "VoyagerImages.h"

TSharedPtr<FVoyagerImages> FVoyagerImages::Create(VoyDevice Device, const FIntPoint& Size,
                                                  uint32 QueueFamily, FString& Error) {
  TSharedPtr<FVoyagerImages> Images = MakeShared<FVoyagerImages>();
  Images->Size = Size;
  Images->QueueFamily = QueueFamily;
  VoyVulkanTargetDesc Vulkan = VOY_VULKAN_TARGET_DESC_INIT;
  Vulkan.imageCount = kImages;
  Vulkan.hasDepth = VK_TRUE;
  VoyTargetDesc Desc = VOY_TARGET_DESC_INIT;
  Desc.next = &Vulkan;
  Desc.kind = VOY_TARGET_KIND_VULKAN;
  Desc.width = static_cast<uint32_t>(Size.X);
  Desc.height = static_cast<uint32_t>(Size.Y);
  if (!VoyagerSucceeded(voyCreateTarget(Device, &Desc, Images->Target.Receive()), Error))
    return nullptr;
  return Images;
}

VoyVulkanUse FVoyagerImages::Use(VkCommandBuffer Commands, int32 Image) const {
  VoyVulkanUse Use = VOY_VULKAN_USE_INIT;  // sampled in a fragment shader
  Use.commandBuffer = Commands;
  Use.queueFamily = QueueFamily;
  Use.imageIndex = static_cast<uint32_t>(Image);
  return Use;
}

bool FVoyagerImages::ReleaseAll(VkCommandBuffer Commands, const FGPUFenceRHIRef& Fence,
                                FString& Error) {
  for (int32 Image = 0; Image < kImages; ++Image)
    if (!Release(Commands, Image, Fence, Error)) return false;
  return true;
}

int32 FVoyagerImages::Acquire(VkCommandBuffer Commands, VoyView View, const VoyFrameEye& Eye,
                              double NearZ, FString& Error) {
  int32 Image = 0;
  while (Image < kImages && !Fences[Image]->Poll()) ++Image;
  if (Image == kImages) return INDEX_NONE;
  VoyVulkanFrame Vulkan = VOY_VULKAN_FRAME_INIT;
  Vulkan.imageIndex = static_cast<uint32_t>(Image);
  VoyFrame Frame = VOY_FRAME_INIT;
  Frame.next = &Vulkan;
  Frame.eyeCount = 1;
  Frame.eyes = &Eye;
  Frame.nearZ = NearZ;
  const VoyVulkanUse Acquired = Use(Commands, Image);
  if (!VoyagerSucceeded(voyRenderFrame(View, &Frame), Error) ||
      !VoyagerSucceeded(voyRecordVulkanAcquire(Target.Get(), &Acquired), Error))
    return INDEX_NONE;
  return Image;
}

bool FVoyagerImages::Release(VkCommandBuffer Commands, int32 Image, const FGPUFenceRHIRef& Fence,
                             FString& Error) {
  Fences[Image] = Fence;
  const VoyVulkanUse Released = Use(Commands, Image);
  return VoyagerSucceeded(voyRecordVulkanRelease(Target.Get(), &Released), Error);
}
