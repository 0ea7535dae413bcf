#pragma once
#include <vulkan/vulkan_core.h>

#include "RHI.h"

class FRHICommandListBase;

struct FVulkanRHIImageViewInfo {
  VkImageView ImageView;
  VkImage Image;
  VkImageSubresourceRange SubresourceRange;
  VkFormat Format;
  uint32 Width, Height, Depth;
};

struct IVulkanDynamicRHI : public FDynamicRHI {
  virtual uint32 RHIGetVulkanVersion() const = 0;
  virtual VkInstance RHIGetVkInstance() const = 0;
  virtual VkDevice RHIGetVkDevice() const = 0;
  virtual VkPhysicalDevice RHIGetVkPhysicalDevice() const = 0;
  virtual uint32 RHIGetGraphicsQueueFamilyIndex() const = 0;
  virtual VkCommandBuffer RHIGetActiveVkCommandBuffer() = 0;  // before 5.8
  virtual VkCommandBuffer RHIGetVkCommandBuffer(FRHICommandListBase& ExecutingCmdList) const = 0;
  virtual void* RHIGetVkDeviceProcAddr(const char* InName) const = 0;
  virtual void* RHIGetVkInstanceProcAddr(const char* InName) const = 0;
  virtual TArray<FAnsiString> RHIGetLoadedDeviceExtensions() const = 0;
  virtual FVulkanRHIImageViewInfo RHIGetImageViewInfo(FRHITexture* InTexture) const = 0;
  virtual void RHIFinishExternalComputeWork(VkCommandBuffer InCommandBuffer) = 0;

  static void AddEnabledInstanceExtensionsAndLayers(TArrayView<const ANSICHAR* const> Extensions,
                                                    TArrayView<const ANSICHAR* const> Layers);
  static void AddEnabledDeviceExtensionsAndLayers(TArrayView<const ANSICHAR* const> Extensions,
                                                  TArrayView<const ANSICHAR* const> Layers);
};

inline IVulkanDynamicRHI* GetIVulkanDynamicRHI() {
  return static_cast<IVulkanDynamicRHI*>(GDynamicRHI);
}
