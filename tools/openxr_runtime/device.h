#pragma once
// The application's VkDevice and the queue of its graphics binding, through the entry points that
// it gave. Work is submitted only inside the calls where OpenXR allows it, and waited for.
#include <functional>

#include "api.h"

namespace test_runtime {

// clang-format off
#define TEST_RUNTIME_DEVICE_FUNCTIONS(X) \
  X(AllocateCommandBuffers) X(AllocateMemory) X(BeginCommandBuffer) X(BindBufferMemory) \
  X(BindImageMemory) X(CmdCopyImageToBuffer) X(CmdPipelineBarrier) X(CreateBuffer) \
  X(CreateCommandPool) X(CreateFence) X(CreateImage) X(DestroyBuffer) X(DestroyCommandPool) \
  X(DestroyFence) X(DestroyImage) X(EndCommandBuffer) X(FreeMemory) \
  X(GetBufferMemoryRequirements) X(GetDeviceQueue) X(GetImageMemoryRequirements) \
  X(InvalidateMappedMemoryRanges) X(MapMemory) X(QueueSubmit) X(ResetCommandPool) \
  X(ResetFences) X(WaitForFences)
// clang-format on
#define TEST_RUNTIME_INSTANCE_FUNCTIONS(X) \
  X(GetPhysicalDeviceImageFormatProperties) X(GetPhysicalDeviceMemoryProperties)

class Device {
 public:
  Device(PFN_vkGetInstanceProcAddr get, const XrGraphicsBindingVulkanKHR& binding);
  ~Device();
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  VkDevice handle() const { return device_; }
  VkPhysicalDevice physical() const { return physical_; }
  // Memory of a type among `allowed` (bits) that has `wanted`, better one that has `better` too.
  VkDeviceMemory allocate(const VkMemoryRequirements& needed, VkMemoryPropertyFlags wanted,
                          VkMemoryPropertyFlags better, VkMemoryPropertyFlags* got = nullptr) const;
  // Records, submits to the application's queue, and waits until it is done.
  void submit(const std::function<void(VkCommandBuffer)>& record) const;

#define TEST_RUNTIME_DECLARE(name) PFN_vk##name name = nullptr;
  TEST_RUNTIME_DEVICE_FUNCTIONS(TEST_RUNTIME_DECLARE)
  TEST_RUNTIME_INSTANCE_FUNCTIONS(TEST_RUNTIME_DECLARE)
#undef TEST_RUNTIME_DECLARE

 private:
  VkPhysicalDevice physical_;
  VkDevice device_;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkFence fence_ = VK_NULL_HANDLE;
};

// Throws std::runtime_error naming the call where it failed.
void check(VkResult result, const char* call);

}  // namespace test_runtime
