#pragma once
// The part of Unity's native plugin interface that this sample uses: names, GUIDs and the order of
// the functions. In a project, replace this header with Unity's own IUnityInterface.h,
// IUnityGraphics.h and IUnityGraphicsVulkan.h, which come with the editor in Data/PluginAPI. The
// sample compiles with either.
#include <vulkan/vulkan_core.h>

#include <cstdint>

#if defined(_WIN32)
#define UNITY_INTERFACE_API __stdcall
#define UNITY_INTERFACE_EXPORT __declspec(dllexport)
#else
#define UNITY_INTERFACE_API
#define UNITY_INTERFACE_EXPORT __attribute__((visibility("default")))
#endif

struct UnityInterfaceGUID {
  unsigned long long m_GUIDHigh, m_GUIDLow;
};

struct IUnityInterface {};

template <class T>
UnityInterfaceGUID GetUnityInterfaceGUID();

struct IUnityInterfaces {
  IUnityInterface*(UNITY_INTERFACE_API* GetInterface)(UnityInterfaceGUID guid);
  void(UNITY_INTERFACE_API* RegisterInterface)(UnityInterfaceGUID guid, IUnityInterface* ptr);
  IUnityInterface*(UNITY_INTERFACE_API* GetInterfaceSplit)(unsigned long long high,
                                                           unsigned long long low);
  void(UNITY_INTERFACE_API* RegisterInterfaceSplit)(unsigned long long high, unsigned long long low,
                                                    IUnityInterface* ptr);

  template <class T>
  T* Get() {
    return static_cast<T*>(GetInterface(GetUnityInterfaceGUID<T>()));
  }
};

// Functions that the sample never calls; they keep their place in the tables.
using UnityUnusedFunction = void(UNITY_INTERFACE_API*)();

// ------------------------------------------------------------------ graphics

enum UnityGfxRenderer { kUnityGfxRendererNull = 4, kUnityGfxRendererVulkan = 21 };

enum UnityGfxDeviceEventType {
  kUnityGfxDeviceEventInitialize = 0,
  kUnityGfxDeviceEventShutdown = 1,
  kUnityGfxDeviceEventBeforeReset = 2,
  kUnityGfxDeviceEventAfterReset = 3
};

using IUnityGraphicsDeviceEventCallback = void(UNITY_INTERFACE_API*)(UnityGfxDeviceEventType);
using UnityRenderingEventAndData = void(UNITY_INTERFACE_API*)(int eventId, void* data);

struct IUnityGraphics : IUnityInterface {
  UnityGfxRenderer(UNITY_INTERFACE_API* GetRenderer)();
  void(UNITY_INTERFACE_API* RegisterDeviceEventCallback)(IUnityGraphicsDeviceEventCallback);
  void(UNITY_INTERFACE_API* UnregisterDeviceEventCallback)(IUnityGraphicsDeviceEventCallback);
  int(UNITY_INTERFACE_API* ReserveEventIDRange)(int count);
};

template <>
inline UnityInterfaceGUID GetUnityInterfaceGUID<IUnityGraphics>() {
  return {0x7CBA0A9CA4DDB544ULL, 0x8C5AD4926EB17B11ULL};
}

// -------------------------------------------------------------------- Vulkan

struct UnityVulkanInstance {
  VkPipelineCache pipelineCache;
  VkInstance instance;
  VkPhysicalDevice physicalDevice;
  VkDevice device;
  VkQueue graphicsQueue;
  PFN_vkGetInstanceProcAddr getInstanceProcAddr;
  unsigned int queueFamilyIndex;
  void* reserved[8];
};

struct UnityVulkanMemory {
  VkDeviceMemory memory;
  VkDeviceSize offset, size;
  void* mapped;
  VkMemoryPropertyFlags flags;
  unsigned int memoryTypeIndex;
  void* reserved[4];
};

struct UnityVulkanImage {
  UnityVulkanMemory memory;
  VkImage image;
  VkImageLayout layout;
  VkImageAspectFlags aspect;
  VkImageUsageFlags usage;
  VkFormat format;
  VkExtent3D extent;
  VkImageTiling tiling;
  VkImageType type;
  VkSampleCountFlagBits samples;
  int layers, mipCount;
  void* reserved[4];
};

struct UnityVulkanRecordingState {
  VkCommandBuffer commandBuffer;
  VkCommandBufferLevel commandBufferLevel;
  VkRenderPass renderPass;
  VkFramebuffer framebuffer;
  int subPassIndex;
  unsigned long long currentFrameNumber;
  unsigned long long safeFrameNumber;  // the GPU has finished this frame
  void* reserved[4];
};

enum UnityVulkanResourceAccessMode {
  kUnityVulkanResourceAccess_ObserveOnly,
  kUnityVulkanResourceAccess_PipelineBarrier,
  kUnityVulkanResourceAccess_Recreate
};

enum UnityVulkanEventRenderPassPreCondition {
  kUnityVulkanRenderPass_DontCare,
  kUnityVulkanRenderPass_EnsureInside,
  kUnityVulkanRenderPass_EnsureOutside
};

enum UnityVulkanGraphicsQueueAccess {
  kUnityVulkanGraphicsQueueAccess_DontCare,
  kUnityVulkanGraphicsQueueAccess_Allow
};

enum UnityVulkanEventConfigFlagBits {
  kUnityVulkanEventConfigFlag_EnsurePreviousFrameSubmission = 1 << 0,
  kUnityVulkanEventConfigFlag_FlushCommandBuffers = 1 << 1,
  kUnityVulkanEventConfigFlag_SyncWorkerThreads = 1 << 2,
  kUnityVulkanEventConfigFlag_ModifiesCommandBuffersState = 1 << 3
};

struct UnityVulkanPluginEventConfig {
  UnityVulkanEventRenderPassPreCondition renderPassPrecondition;
  UnityVulkanGraphicsQueueAccess graphicsQueueAccess;
  uint32_t flags;
};

using UnityVulkanInitCallback = PFN_vkGetInstanceProcAddr(UNITY_INTERFACE_API*)(
    PFN_vkGetInstanceProcAddr getInstanceProcAddr, void* userdata);

struct IUnityGraphicsVulkan : IUnityInterface {
  bool(UNITY_INTERFACE_API* InterceptInitialization)(UnityVulkanInitCallback func, void* userdata);
  UnityUnusedFunction InterceptVulkanAPI;
  void(UNITY_INTERFACE_API* ConfigureEvent)(int eventID,
                                            const UnityVulkanPluginEventConfig* config);
  UnityVulkanInstance(UNITY_INTERFACE_API* Instance)();
  bool(UNITY_INTERFACE_API* CommandRecordingState)(UnityVulkanRecordingState* state,
                                                   UnityVulkanGraphicsQueueAccess queueAccess);
  bool(UNITY_INTERFACE_API* AccessTexture)(void* nativeTexture,
                                           const VkImageSubresource* subResource,
                                           VkImageLayout layout, VkPipelineStageFlags stages,
                                           VkAccessFlags access, UnityVulkanResourceAccessMode mode,
                                           UnityVulkanImage* image);
  UnityUnusedFunction AccessRenderBufferTexture;
  UnityUnusedFunction AccessRenderBufferResolveTexture;
  UnityUnusedFunction AccessBuffer;
  UnityUnusedFunction EnsureOutsideRenderPass;
  UnityUnusedFunction EnsureInsideRenderPass;
  void(UNITY_INTERFACE_API* AccessQueue)(UnityRenderingEventAndData callback, int eventId,
                                         void* userData, bool flush);
  UnityUnusedFunction ConfigureSwapchain;
  UnityUnusedFunction AccessTextureByID;
};

template <>
inline UnityInterfaceGUID GetUnityInterfaceGUID<IUnityGraphicsVulkan>() {
  return {0x95355348D4EF4E11ULL, 0x9789313DFCFFCC87ULL};
}

// Newer editors offer it as well. Several plugins can intercept the initialisation through it.
struct IUnityGraphicsVulkanV2 : IUnityInterface {
  UnityUnusedFunction sameAsIUnityGraphicsVulkan[14];
  bool(UNITY_INTERFACE_API* AddInterceptInitialization)(UnityVulkanInitCallback func,
                                                        void* userdata, int32_t priority);
  UnityUnusedFunction RemoveInterceptInitialization;
};

template <>
inline UnityInterfaceGUID GetUnityInterfaceGUID<IUnityGraphicsVulkanV2>() {
  return {0x329334C09DCA4787ULL, 0xB347DD92A0097FFCULL};
}

extern "C" {
UNITY_INTERFACE_EXPORT void UNITY_INTERFACE_API UnityPluginLoad(IUnityInterfaces* interfaces);
UNITY_INTERFACE_EXPORT void UNITY_INTERFACE_API UnityPluginUnload();
}
