#pragma once
// A Vulkan host for benchmarks, as small as it goes.
#include <vulkan/vulkan.h>

#include <array>

#include "runtime/base/error.h"
#include "vulkan_interop/device.h"

namespace voyager {

struct Host {
  static void check(VkResult status) { vulkan::check(status, "the benchmark's own Vulkan"); }

  static constexpr uint32_t kVersion = VK_API_VERSION_1_2;
  static constexpr const char* kExtensions[] = {VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME,
                                                VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME};

  explicit Host(const std::array<uint8_t, 16>& uuid) {
    VkApplicationInfo application{};
    application.sType = VK_STRUCTURE_TYPE_APPLICATION_INFO;
    application.apiVersion = kVersion;
    VkInstanceCreateInfo info{};
    info.sType = VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO;
    info.pApplicationInfo = &application;
    check(vkCreateInstance(&info, nullptr, &instance));
    uint32_t count = 8;
    VkPhysicalDevice devices[8];
    check(vkEnumeratePhysicalDevices(instance, &count, devices));
    for (uint32_t i = 0; i < count; ++i)
      if (vulkan::PhysicalDevice(vkGetInstanceProcAddr, instance, devices[i]).uuid() == uuid)
        physical = devices[i];
    if (physical == VK_NULL_HANDLE)
      throw Error(ErrorCode::no_device, "Vulkan: found no device with the CUDA device's UUID");
    const float priority = 1;
    const VkDeviceQueueCreateInfo queues{
        VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, 0, 1, &priority};
    VkPhysicalDeviceTimelineSemaphoreFeatures timelines{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_TIMELINE_SEMAPHORE_FEATURES, nullptr, VK_TRUE};
    VkDeviceCreateInfo made{};
    made.sType = VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO;
    made.pNext = &timelines;
    made.queueCreateInfoCount = 1;
    made.pQueueCreateInfos = &queues;
    made.enabledExtensionCount = 2;
    made.ppEnabledExtensionNames = kExtensions;
    check(vkCreateDevice(physical, &made, nullptr, &device));
    vkGetDeviceQueue(device, 0, 0, &queue);
    const VkCommandPoolCreateInfo commands{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr,
                                           VK_COMMAND_POOL_CREATE_RESET_COMMAND_BUFFER_BIT, 0};
    check(vkCreateCommandPool(device, &commands, nullptr, &pool));
  }
  ~Host() {
    vkDestroyCommandPool(device, pool, nullptr);
    vkDestroyDevice(device, nullptr);
    vkDestroyInstance(instance, nullptr);
  }
  Host(const Host&) = delete;
  Host& operator=(const Host&) = delete;

  // With DEVICE sharing.
  vulkan::DeviceDesc desc(vulkan::Sync sync) const {
    vulkan::DeviceDesc desc;
    desc.get = vkGetInstanceProcAddr;
    desc.instance = instance;
    desc.physical_device = physical;
    desc.device = device;
    desc.version = kVersion;
    desc.extensions = {kExtensions[0], kExtensions[1]};
    desc.timelines = true;
    desc.sharing = vulkan::Sharing::device;
    desc.sync = sync;
    return desc;
  }

  VkCommandBuffer allocate() const {
    const VkCommandBufferAllocateInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr,
                                           pool, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
    VkCommandBuffer commands = VK_NULL_HANDLE;
    check(vkAllocateCommandBuffers(device, &info, &commands));
    return commands;
  }
  static void begin(VkCommandBuffer commands) {
    const VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                        VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
    check(vkBeginCommandBuffer(commands, &info));
  }
  void submit(VkCommandBuffer commands, VkSemaphore wait, VkSemaphore signal, uint64_t value,
              bool timelines, VkFence fence) const {
    check(vkEndCommandBuffer(commands));
    const VkTimelineSemaphoreSubmitInfo values{VK_STRUCTURE_TYPE_TIMELINE_SEMAPHORE_SUBMIT_INFO,
                                               nullptr,
                                               wait != VK_NULL_HANDLE,
                                               &value,
                                               signal != VK_NULL_HANDLE,
                                               &value};
    const VkPipelineStageFlags stage = VK_PIPELINE_STAGE_ALL_COMMANDS_BIT;
    VkSubmitInfo info{};
    info.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    info.pNext = timelines ? &values : nullptr;
    info.waitSemaphoreCount = wait != VK_NULL_HANDLE;
    info.pWaitSemaphores = &wait;
    info.pWaitDstStageMask = &stage;
    info.commandBufferCount = 1;
    info.pCommandBuffers = &commands;
    info.signalSemaphoreCount = signal != VK_NULL_HANDLE;
    info.pSignalSemaphores = &signal;
    check(vkQueueSubmit(queue, 1, &info, fence));
  }
  void wait_for(VkFence fence) const {
    check(vkWaitForFences(device, 1, &fence, VK_TRUE, UINT64_MAX));
    check(vkResetFences(device, 1, &fence));
  }

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  VkCommandPool pool = VK_NULL_HANDLE;
};

}  // namespace voyager
