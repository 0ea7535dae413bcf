#pragma once
// Unreal's Vulkan device, as Voyager needs to know it. Unreal has loaded Vulkan, so the module
// links no Vulkan library.
#include <voyager/voyager_vulkan.h>

#include "CoreMinimal.h"

class FRHICommandListBase;

// Asks Unreal to enable what Voyager can use. Before Unreal makes its device: in StartupModule of a
// module with the loading phase PostConfigInit. Unreal leaves out what a device does not have.
void RequestVoyagerVulkanExtensions();

// Makes a VoyDevice on Unreal's device. False with an error, for example where another RHI than
// Vulkan draws.
bool CreateVoyagerDevice(VoyDevice* Device, FString& Error);

// The command buffer of a list that is being executed.
VkCommandBuffer GetVoyagerCommandBuffer(FRHICommandListBase& Executing);

struct FVoyagerVulkanFunctions {
  // Of Unreal's device.
  FVoyagerVulkanFunctions();

  VkDevice Device;
  PFN_vkCreateRenderPass CreateRenderPass;
  PFN_vkDestroyRenderPass DestroyRenderPass;
  PFN_vkCreateFramebuffer CreateFramebuffer;
  PFN_vkDestroyFramebuffer DestroyFramebuffer;
  PFN_vkCreateImageView CreateImageView;
  PFN_vkDestroyImageView DestroyImageView;
  PFN_vkCmdBeginRenderPass BeginRenderPass;
  PFN_vkCmdEndRenderPass EndRenderPass;
  PFN_vkDeviceWaitIdle WaitIdle;
};
