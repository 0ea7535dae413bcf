#pragma once
// A render pass over Unreal's textures in which Voyager composites its image. The textures are in
// TRANSFER_DST_OPTIMAL before and after it, which is what ERHIAccess::CopyDest means in every
// version of Unreal; the layouts of attachments have changed.
#include "CoreMinimal.h"
#include "IVulkanDynamicRHI.h"
#include "VoyagerHandles.h"
#include "VoyagerVulkan.h"

// Views and a framebuffer of textures, for one frame: Unreal may replace the images at any time.
struct FVoyagerAttachments {
  explicit FVoyagerAttachments(const FVoyagerVulkanFunctions& InFunctions)
      : Functions(InFunctions) {}
  // The GPU must have finished the frame.
  ~FVoyagerAttachments();

  const FVoyagerVulkanFunctions& Functions;
  VkImageView Views[2] = {};
  VkFramebuffer Framebuffer = VK_NULL_HANDLE;
};

// For textures of two formats.
class FVoyagerComposite {
 public:
  static TSharedPtr<FVoyagerComposite> Create(const FVoyagerVulkanFunctions& Functions,
                                              VoyDevice Device, VkFormat Color, VkFormat Depth,
                                              FString& Error);
  // The GPU must have finished all frames that used it.
  ~FVoyagerComposite();

  bool Fits(VkFormat Color, VkFormat Depth) const {
    return Color == ColorFormat && Depth == DepthFormat;
  }
  // Records the pass. Draw lacks only the command buffer. NULL with an error; what is returned
  // lives until the GPU has finished the frame.
  TSharedPtr<FVoyagerAttachments> Record(VkCommandBuffer Commands,
                                         const FVulkanRHIImageViewInfo& Color,
                                         const FVulkanRHIImageViewInfo& Depth,
                                         VoyVulkanCompositeDraw Draw, FString& Error) const;

 private:
  explicit FVoyagerComposite(const FVoyagerVulkanFunctions& InFunctions) : Functions(InFunctions) {}
  VkResult CreateRenderPass();
  TSharedPtr<FVoyagerAttachments> Attach(const FVulkanRHIImageViewInfo& Color,
                                         const FVulkanRHIImageViewInfo& Depth,
                                         const VkExtent2D& Extent, FString& Error) const;

  const FVoyagerVulkanFunctions& Functions;
  VkFormat ColorFormat = VK_FORMAT_UNDEFINED, DepthFormat = VK_FORMAT_UNDEFINED;
  VkRenderPass Pass = VK_NULL_HANDLE;
  FVoyagerCompositeHandle Composite;
};
