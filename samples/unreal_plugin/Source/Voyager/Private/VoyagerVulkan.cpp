#include "VoyagerVulkan.h"

#include "IVulkanDynamicRHI.h"
#include "Misc/EngineVersionComparison.h"
#include "VoyagerHandles.h"

namespace {

// Voyager asks for functions of the instance only, and Unreal has one instance.
VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL GetInstanceProcAddr(VkInstance, const char* Name) {
  return reinterpret_cast<PFN_vkVoidFunction>(
      GetIVulkanDynamicRHI()->RHIGetVkInstanceProcAddr(Name));
}

template <class FunctionType>
void Load(FunctionType& Function, const char* Name) {
  Function = reinterpret_cast<FunctionType>(GetIVulkanDynamicRHI()->RHIGetVkDeviceProcAddr(Name));
}

}  // namespace

void RequestVoyagerVulkanExtensions() {
  VoyVulkanRequirements Needs = VOY_VULKAN_REQUIREMENTS_INIT;
  if (voyGetVulkanRequirements(nullptr, &Needs) < 0) return;
  IVulkanDynamicRHI::AddEnabledInstanceExtensionsAndLayers(
      TArrayView<const ANSICHAR* const>(Needs.instanceExtensions,
                                        static_cast<int32>(Needs.instanceExtensionCount)),
      TArrayView<const ANSICHAR* const>());
  IVulkanDynamicRHI::AddEnabledDeviceExtensionsAndLayers(
      TArrayView<const ANSICHAR* const>(Needs.deviceExtensions,
                                        static_cast<int32>(Needs.deviceExtensionCount)),
      TArrayView<const ANSICHAR* const>());
}

bool CreateVoyagerDevice(VoyDevice* Device, FString& Error) {
  if (!GDynamicRHI || GDynamicRHI->GetInterfaceType() != ERHIInterfaceType::Vulkan) {
    Error = TEXT("found another RHI, expected Vulkan (start the engine with -vulkan)");
    return false;
  }
  IVulkanDynamicRHI* RHI = GetIVulkanDynamicRHI();
  const TArray<FAnsiString> Enabled = RHI->RHIGetLoadedDeviceExtensions();
  TArray<const ANSICHAR*> Names;
  for (const FAnsiString& Name : Enabled) Names.Add(*Name);
  VoyVulkanDeviceDesc Vulkan = VOY_VULKAN_DEVICE_DESC_INIT;
  Vulkan.getInstanceProcAddr = GetInstanceProcAddr;
  Vulkan.instance = RHI->RHIGetVkInstance();
  Vulkan.physicalDevice = RHI->RHIGetVkPhysicalDevice();
  Vulkan.device = RHI->RHIGetVkDevice();
  Vulkan.vulkanVersion = RHI->RHIGetVulkanVersion();
  Vulkan.deviceExtensionCount = static_cast<uint32_t>(Names.Num());
  Vulkan.deviceExtensions = Names.GetData();
  Vulkan.sync = VOY_VULKAN_SYNC_HOST;  // Unreal's submissions take no semaphores from plugins
  VoyDeviceDesc Desc = VOY_DEVICE_DESC_INIT;
  Desc.next = &Vulkan;
  return VoyagerSucceeded(voyCreateDevice(&Desc, Device), Error);
}

VkCommandBuffer GetVoyagerCommandBuffer([[maybe_unused]] FRHICommandListBase& Executing) {
#if UE_VERSION_OLDER_THAN(5, 8, 0)
  return GetIVulkanDynamicRHI()->RHIGetActiveVkCommandBuffer();
#else
  return GetIVulkanDynamicRHI()->RHIGetVkCommandBuffer(Executing);
#endif
}

FVoyagerVulkanFunctions::FVoyagerVulkanFunctions()
    : Device(GetIVulkanDynamicRHI()->RHIGetVkDevice()) {
  Load(CreateRenderPass, "vkCreateRenderPass");
  Load(DestroyRenderPass, "vkDestroyRenderPass");
  Load(CreateFramebuffer, "vkCreateFramebuffer");
  Load(DestroyFramebuffer, "vkDestroyFramebuffer");
  Load(CreateImageView, "vkCreateImageView");
  Load(DestroyImageView, "vkDestroyImageView");
  Load(BeginRenderPass, "vkCmdBeginRenderPass");
  Load(EndRenderPass, "vkCmdEndRenderPass");
  Load(WaitIdle, "vkDeviceWaitIdle");
}
