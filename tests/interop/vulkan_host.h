#pragma once
// A Vulkan host for tests: instance, device, queue, buffers and images, and one-time commands.
#include <gtest/gtest.h>
#include <voyager/voyager_vulkan.h>
#include <vulkan/vulkan.h>

#include <cstdlib>
#include <cstring>
#include <string>
#include <vector>

inline void expect_vk(VkResult result, const char* what) {
  EXPECT_EQ(result, VK_SUCCESS) << what;
}
#define VK(call) expect_vk(call, #call)

// Validation messages, where the layer is there.
struct Messages {
  std::vector<std::string> text;
  static VKAPI_ATTR VkBool32 VKAPI_CALL take(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                             VkDebugUtilsMessageTypeFlagsEXT,
                                             const VkDebugUtilsMessengerCallbackDataEXT* data,
                                             void* user) {
    static_cast<Messages*>(user)->text.emplace_back(data->pMessage);
    return VK_FALSE;
  }
};

// A semaphore and, for timelines, its value; none where it is NULL.
struct Point {
  VkSemaphore semaphore = VK_NULL_HANDLE;
  uint64_t value = 0;
};

// How instance and device are made.
struct VulkanCreation {
  PFN_vkGetInstanceProcAddr loader = vkGetInstanceProcAddr;  // gives vkCreateInstance and Device
  bool asks_voyager = true;                                  // what to enable
  void* features = nullptr;                                  // the chain, where it does not ask
  std::vector<const char*> extensions;                       // the device's, where it does not ask
  uint32_t api_version = VK_API_VERSION_1_2;
};

class VulkanHost {
 public:
  // Nothing is made where there is no Vulkan device: see exists().
  explicit VulkanHost(const VulkanCreation& how = {}) : creation(how) {
    make_instance();
    if (instance != VK_NULL_HANDLE) choose_device();
    if (physical != VK_NULL_HANDLE) make_device();
  }
  ~VulkanHost() {
    if (device != VK_NULL_HANDLE) {
      vkDeviceWaitIdle(device);
      vkDestroyCommandPool(device, pool, nullptr);
      vkDestroyDevice(device, nullptr);
    }
    if (messenger_ != VK_NULL_HANDLE) {
      const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
          vkGetInstanceProcAddr(instance, "vkDestroyDebugUtilsMessengerEXT"));
      destroy(instance, messenger_, nullptr);
    }
    if (instance != VK_NULL_HANDLE) vkDestroyInstance(instance, nullptr);
    EXPECT_TRUE(messages.text.empty()) << messages.text.front();
  }
  VulkanHost(const VulkanHost&) = delete;
  VulkanHost& operator=(const VulkanHost&) = delete;

  bool exists() const { return device != VK_NULL_HANDLE; }
  bool validates() const { return messenger_ != VK_NULL_HANDLE; }

  VoyVulkanDeviceDesc desc(VoyVulkanSharing sharing = VOY_VULKAN_SHARING_AUTO,
                           VoyVulkanSync sync = VOY_VULKAN_SYNC_AUTO) const {
    VoyVulkanDeviceDesc out = VOY_VULKAN_DEVICE_DESC_INIT;
    out.getInstanceProcAddr = vkGetInstanceProcAddr;
    out.instance = instance;
    out.physicalDevice = physical;
    out.device = device;
    out.vulkanVersion = creation.api_version;
    out.deviceExtensionCount = static_cast<uint32_t>(extensions.size());
    out.deviceExtensions = extensions.data();
    out.timelineSemaphore = timelines;
    out.sharing = sharing;
    out.sync = sync;
    return out;
  }

  VkCommandBuffer begin() const {
    const VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr,
                                           pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBuffer commands = VK_NULL_HANDLE;
    VK(vkAllocateCommandBuffers(device, &info, &commands));
    const VkCommandBufferBeginInfo begin{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                         VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
    VK(vkBeginCommandBuffer(commands, &begin));
    return commands;
  }

  void submit(VkCommandBuffer commands, const Point& wait, const Point& signal,
              VkFence fence = VK_NULL_HANDLE) const {
    VK(vkEndCommandBuffer(commands));
    const bool waits = wait.semaphore != VK_NULL_HANDLE,
               signals = signal.semaphore != VK_NULL_HANDLE;
    const VkTimelineSemaphoreSubmitInfo values{VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                               nullptr,
                                               waits ? 1u : 0u,
                                               &wait.value,
                                               signals ? 1u : 0u,
                                               &signal.value};
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.pNext = timelines ? &values : nullptr;
    info.waitSemaphoreCount = waits ? 1 : 0;
    info.pWaitSemaphores = &wait.semaphore;
    info.pWaitDstStageMask = &stage;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    info.signalSemaphoreCount = signals ? 1 : 0;
    info.pSignalSemaphores = &signal.semaphore;
    VK(vkQueueSubmit(queue, 1, &info, fence));
  }
  void finish(VkCommandBuffer commands, const Point& wait = {}, const Point& signal = {}) const {
    const VkFence fence = make_fence();
    submit(commands, wait, signal, fence);
    wait_for(fence);
    vkDestroyFence(device, fence, nullptr);
    vkFreeCommandBuffers(device, pool, 1, &commands);
  }
  VkFence make_fence() const {
    const VkFenceCreateInfo info{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, 0};
    VkFence fence = VK_NULL_HANDLE;
    VK(vkCreateFence(device, &info, nullptr, &fence));
    return fence;
  }
  void wait_for(VkFence fence) const {
    VK(vkWaitForFences(device, 1, &fence, VK_TRUE, UINT64_C(20'000'000'000)));
  }

  uint32_t memory_type(uint32_t types, VkMemoryPropertyFlags flags) const {
    VkPhysicalDeviceMemoryProperties memory;
    vkGetPhysicalDeviceMemoryProperties(physical, &memory);
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
      if ((types >> i & 1) != 0 && (memory.memoryTypes[i].propertyFlags & flags) == flags) return i;
    ADD_FAILURE() << "no memory type";
    return 0;
  }

  VulkanCreation creation;
  Messages messages;
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
  uint32_t family = 0;
  std::vector<const char*> extensions;
  VkBool32 timelines = VK_FALSE;
  std::string name;

 private:
  static bool has_validation() {
    uint32_t count = 0;
    vkEnumerateInstanceLayerProperties(&count, nullptr);
    std::vector<VkLayerProperties> layers(count);
    vkEnumerateInstanceLayerProperties(&count, layers.data());
    for (const VkLayerProperties& layer : layers)
      if (std::strcmp(layer.layerName, kLayer) == 0) return true;
    return false;
  }

  void make_instance() {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = creation.api_version;
    const VkValidationFeatureEnableEXT checks[] = {
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    VkValidationFeaturesEXT features{};
    features.sType = VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT;
    features.enabledValidationFeatureCount = 1;
    features.pEnabledValidationFeatures = checks;
    const VkDebugUtilsMessengerCreateInfoEXT debug = messenger_info(&features);
    const char* layer = kLayer;
    const char* extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    const bool validation = has_validation();
    if (validation) {
      // Hazards between submissions are an option of its own; later layers always look for them.
      ::setenv("VK_LAYER_ENABLES",
               "VALIDATION_CHECK_ENABLE_SYNCHRONIZATION_VALIDATION_QUEUE_SUBMIT", 0);
      info.pNext = &debug;
      info.enabledLayerCount = 1;
      info.ppEnabledLayerNames = &layer;
      info.enabledExtensionCount = 1;
      info.ppEnabledExtensionNames = &extension;
    }
    const auto create_instance =
        reinterpret_cast<PFN_vkCreateInstance>(creation.loader(VK_NULL_HANDLE, "vkCreateInstance"));
    if (create_instance(&info, nullptr, &instance) != VK_SUCCESS) {
      instance = VK_NULL_HANDLE;
      return;
    }
    if (!validation) return;
    const VkDebugUtilsMessengerCreateInfoEXT messenger = messenger_info(nullptr);
    const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance, "vkCreateDebugUtilsMessengerEXT"));
    VK(create(instance, &messenger, nullptr, &messenger_));
  }

  VkDebugUtilsMessengerCreateInfoEXT messenger_info(const void* next) {
    VkDebugUtilsMessengerCreateInfoEXT info{};
    info.sType = VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT;
    info.pNext = next;
    info.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT |
                           VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    info.pfnUserCallback = Messages::take;
    info.pUserData = &messages;
    return info;
  }

  // A GPU before others.
  void choose_device() {
    uint32_t count = 0;
    vkEnumeratePhysicalDevices(instance, &count, nullptr);
    std::vector<VkPhysicalDevice> found(count);
    vkEnumeratePhysicalDevices(instance, &count, found.data());
    for (const VkPhysicalDevice candidate : found) {
      VkPhysicalDeviceProperties properties;
      vkGetPhysicalDeviceProperties(candidate, &properties);
      const bool gpu = properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU ||
                       properties.deviceType == VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU;
      if (physical != VK_NULL_HANDLE && !gpu) continue;
      physical = candidate;
      name = properties.deviceName;
      if (gpu) break;
    }
  }

  void ask_voyager() {
    VoyVulkanPhysicalDevice self = VOY_VULKAN_PHYSICAL_DEVICE_INIT;
    self.getInstanceProcAddr = vkGetInstanceProcAddr;
    self.instance = instance;
    self.physicalDevice = physical;
    VoyVulkanRequirements needs = VOY_VULKAN_REQUIREMENTS_INIT;
    ASSERT_EQ(voyGetVulkanRequirements(&self, &needs), VOY_SUCCESS) << voyGetLastErrorMessage();
    extensions.assign(needs.deviceExtensions, needs.deviceExtensions + needs.deviceExtensionCount);
    timelines = needs.timelineSemaphore;
  }

  void make_device() {
    extensions = creation.extensions;
    if (creation.asks_voyager) ask_voyager();
    const float priority = 1;
    const VkDeviceQueueCreateInfo queues{
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, family, 1, &priority};
    const VkPhysicalDeviceTimelineSemaphoreFeatures features{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES, nullptr, timelines};
    VkDeviceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    info.pNext = creation.asks_voyager ? &features : creation.features;
    info.queueCreateInfoCount = 1;
    info.pQueueCreateInfos = &queues;
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    const auto create_device =
        reinterpret_cast<PFN_vkCreateDevice>(creation.loader(instance, "vkCreateDevice"));
    VK(create_device(physical, &info, nullptr, &device));
    vkGetDeviceQueue(device, family, 0, &queue);
    const VkCommandPoolCreateInfo commands{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                           VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, family};
    VK(vkCreateCommandPool(device, &commands, nullptr, &pool));
  }

  static constexpr const char* kLayer = "VK_LAYER_KHRONOS_validation";
  VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
};
