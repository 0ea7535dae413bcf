#pragma once
// The Vulkan of a test's application: made through the runtime, watched by the validation layer.
#include <gtest/gtest.h>
#include <vulkan/vulkan.h>

#define XR_USE_GRAPHICS_API_VULKAN
#include <openxr/openxr.h>
#include <openxr/openxr_platform.h>

#include <cstring>
#include <functional>
#include <string>
#include <vector>

namespace test_runtime::test {

template <class Function>
Function find(XrInstance instance, const char* name) {
  PFN_xrVoidFunction function = nullptr;
  EXPECT_EQ(xrGetInstanceProcAddr(instance, name, &function), XR_SUCCESS) << name;
  return reinterpret_cast<Function>(function);
}

// One with its type set, and zeros.
template <class T>
T typed(XrStructureType type) {
  T structure = {};
  structure.type = type;
  return structure;
}

inline bool has_validation_layer() {
  uint32_t count = 0;
  vkEnumerateInstanceLayerProperties(&count, nullptr);
  std::vector<VkLayerProperties> layers(count);
  vkEnumerateInstanceLayerProperties(&count, layers.data());
  for (const VkLayerProperties& layer : layers)
    if (std::strcmp(layer.layerName, "VK_LAYER_KHRONOS_validation") == 0) return true;
  return false;
}

class VulkanClient {
 public:
  VulkanClient(XrInstance xr, XrSystemId system) {
    create_instance(xr, system);
    if (instance) create_device(xr, system);
  }
  ~VulkanClient() {
    if (device) vkDestroyCommandPool(device, pool_, nullptr);
    if (device) vkDestroyDevice(device, nullptr);
    if (messenger_)
      reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(
          instance, "vkDestroyDebugUtilsMessengerEXT"))(instance, messenger_, nullptr);
    if (instance) vkDestroyInstance(instance, nullptr);
  }
  VulkanClient(const VulkanClient&) = delete;
  VulkanClient& operator=(const VulkanClient&) = delete;

  XrGraphicsBindingVulkan2KHR binding() const {
    return {XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR, nullptr, instance, physical, device, 0, 0};
  }

  // An image from OpenXR's layout and back, filled in between; nothing waits for it.
  void fill(VkImage image, bool depth, uint32_t layers,
            const std::function<void(VkCommandBuffer)>& clear) {
    VkCommandBuffer commands = VK_NULL_HANDLE;
    const VkCommandBufferAllocateInfo one = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO,
                                             nullptr, pool_, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    ASSERT_EQ(vkAllocateCommandBuffers(device, &one, &commands), VK_SUCCESS);
    const VkCommandBufferBeginInfo begin = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                            VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
    vkBeginCommandBuffer(commands, &begin);
    const VkImageLayout given = depth ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL
                                      : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    move(commands, image, depth, layers, given, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL);
    clear(commands);
    move(commands, image, depth, layers, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
         home == VK_IMAGE_LAYOUT_UNDEFINED ? given : home);
    vkEndCommandBuffer(commands);
    VkSubmitInfo submit = {};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    ASSERT_EQ(vkQueueSubmit(queue, 1, &submit, VK_NULL_HANDLE), VK_SUCCESS);
  }

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  int messages = 0;                                // of the validation layer
  VkImageLayout home = VK_IMAGE_LAYOUT_UNDEFINED;  // to leave images in, not OpenXR's

 private:
  static VKAPI_ATTR VkBool32 VKAPI_CALL report(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                               VkDebugUtilsMessageTypeFlagsEXT,
                                               const VkDebugUtilsMessengerCallbackDataEXT* data,
                                               void* self) {
    ++static_cast<VulkanClient*>(self)->messages;
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    return VK_FALSE;
  }

  static void move(VkCommandBuffer commands, VkImage image, bool depth, uint32_t layers,
                   VkImageLayout from, VkImageLayout to) {
    const VkImageMemoryBarrier barrier = {
        VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER,
        nullptr,
        VK_ACCESS_MEMORY_WRITE_BIT,
        VK_ACCESS_MEMORY_WRITE_BIT | VK_ACCESS_MEMORY_READ_BIT,
        from,
        to,
        VK_QUEUE_FAMILY_IGNORED,
        VK_QUEUE_FAMILY_IGNORED,
        image,
        {VkImageAspectFlags(depth ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT), 0, 1, 0,
         layers}};
    vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                         VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1,
                         &barrier);
  }

  void create_instance(XrInstance xr, XrSystemId system) {
    VkApplicationInfo application = {};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = VK_API_VERSION_1_1;
    VkInstanceCreateInfo info = {};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    constexpr VkValidationFeatureEnableEXT kSynchronisation =
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
    VkDebugUtilsMessengerCreateInfoEXT messenger = {};
    messenger.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    messenger.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                                VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    messenger.pfnUserCallback = report;
    messenger.pUserData = this;
    VkValidationFeaturesEXT features = {};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.pNext = &messenger;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = &kSynchronisation;
    const char* layer = "VK_LAYER_KHRONOS_validation";
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    if (has_validation_layer()) {
      info.pNext = &features;
      info.enabledLayerCount = info.enabledExtensionCount = 1;
      info.ppEnabledLayerNames = &layer;
      info.ppEnabledExtensionNames = &extension;
    }
    const XrVulkanInstanceCreateInfoKHR create = {XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR,
                                                  nullptr,
                                                  system,
                                                  0,
                                                  &vkGetInstanceProcAddr,
                                                  &info,
                                                  nullptr};
    VkResult result = VK_SUCCESS;
    EXPECT_EQ(find<PFN_xrCreateVulkanInstanceKHR>(xr, "xrCreateVulkanInstanceKHR")(
                  xr, &create, &instance, &result),
              XR_SUCCESS);
    EXPECT_EQ(result, VK_SUCCESS);
    if (instance && info.enabledLayerCount)
      reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(vkGetInstanceProcAddr(
          instance, "vkCreateDebugUtilsMessengerEXT"))(instance, &messenger, nullptr, &messenger_);
  }

  void create_device(XrInstance xr, XrSystemId system) {
    const XrVulkanGraphicsDeviceGetInfoKHR get = {XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR,
                                                  nullptr, system, instance};
    const XrResult got = find<PFN_xrGetVulkanGraphicsDevice2KHR>(
        xr, "xrGetVulkanGraphicsDevice2KHR")(xr, &get, &physical);
    if (got != XR_SUCCESS) return;
    const float priority = 1;
    VkDeviceQueueCreateInfo queue_info = {};
    queue_info.sType = VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO;
    queue_info.queueCount = 1;
    queue_info.pQueuePriorities = &priority;
    VkDeviceCreateInfo info = {};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queue_info;
    const XrVulkanDeviceCreateInfoKHR create = {XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR,
                                                nullptr,
                                                system,
                                                0,
                                                &vkGetInstanceProcAddr,
                                                physical,
                                                &info,
                                                nullptr};
    VkResult result = VK_SUCCESS;
    ASSERT_EQ(find<PFN_xrCreateVulkanDeviceKHR>(xr, "xrCreateVulkanDeviceKHR")(xr, &create, &device,
                                                                               &result),
              XR_SUCCESS);
    ASSERT_EQ(result, VK_SUCCESS);
    vkGetDeviceQueue(device, 0, 0, &queue);
    const VkCommandPoolCreateInfo pool = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0,
                                          0};
    ASSERT_EQ(vkCreateCommandPool(device, &pool, nullptr, &pool_), VK_SUCCESS);
  }

  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
};

}  // namespace test_runtime::test
