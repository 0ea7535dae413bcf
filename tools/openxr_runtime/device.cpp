#include "device.h"

#include <stdexcept>

namespace test_runtime {
namespace {

constexpr uint64_t kLongest = 20000000000;  // nanoseconds; what the application queued counts too

}  // namespace

void check(VkResult result, const char* call) {
  if (result != VK_SUCCESS)
    throw std::runtime_error(std::string(call) + ": VkResult " + std::to_string(result));
}

Device::Device(PFN_vkGetInstanceProcAddr get, const XrGraphicsBindingVulkanKHR& binding)
    : physical_(binding.physicalDevice), device_(binding.device) {
  const auto get_device =
      reinterpret_cast<PFN_vkGetDeviceProcAddr>(get(binding.instance, "vkGetDeviceProcAddr"));
#define TEST_RUNTIME_LOAD(name) \
  name = reinterpret_cast<PFN_vk##name>(get_device(device_, "vk" #name));
  TEST_RUNTIME_DEVICE_FUNCTIONS(TEST_RUNTIME_LOAD)
#undef TEST_RUNTIME_LOAD
#define TEST_RUNTIME_LOAD(name) \
  name = reinterpret_cast<PFN_vk##name>(get(binding.instance, "vk" #name));
  TEST_RUNTIME_INSTANCE_FUNCTIONS(TEST_RUNTIME_LOAD)
#undef TEST_RUNTIME_LOAD
  GetDeviceQueue(device_, binding.queueFamilyIndex, binding.queueIndex, &queue_);
  const VkCommandPoolCreateInfo pool = {VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO, nullptr, 0,
                                        binding.queueFamilyIndex};
  check(CreateCommandPool(device_, &pool, nullptr, &pool_), "vkCreateCommandPool");
  const VkCommandBufferAllocateInfo one = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO, nullptr,
                                           pool_, VK_COMMAND_BUFFER_LEVEL_PRIMARY, 1};
  check(AllocateCommandBuffers(device_, &one, &commands_), "vkAllocateCommandBuffers");
  const VkFenceCreateInfo fence = {VK_STRUCTURE_TYPE_FENCE_CREATE_INFO, nullptr, 0};
  check(CreateFence(device_, &fence, nullptr, &fence_), "vkCreateFence");
}

Device::~Device() {
  DestroyFence(device_, fence_, nullptr);
  DestroyCommandPool(device_, pool_, nullptr);
}

VkDeviceMemory Device::allocate(const VkMemoryRequirements& needed, VkMemoryPropertyFlags wanted,
                                VkMemoryPropertyFlags better, VkMemoryPropertyFlags* got) const {
  VkPhysicalDeviceMemoryProperties memory;
  GetPhysicalDeviceMemoryProperties(physical_, &memory);
  for (const VkMemoryPropertyFlags flags : {wanted | better, wanted, VkMemoryPropertyFlags{0}})
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
      const VkMemoryPropertyFlags has = memory.memoryTypes[i].propertyFlags;
      const bool special =
          has & (VK_MEMORY_PROPERTY_PROTECTED_BIT | VK_MEMORY_PROPERTY_LAZILY_ALLOCATED_BIT |
                 VK_MEMORY_PROPERTY_DEVICE_COHERENT_BIT_AMD);
      if (!(needed.memoryTypeBits >> i & 1) || (has & flags) != flags || special ||
          (has & wanted & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT) !=
              (wanted & VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT))
        continue;
      const VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr,
                                         needed.size, i};
      VkDeviceMemory allocated = VK_NULL_HANDLE;
      if (AllocateMemory(device_, &info, nullptr, &allocated) != VK_SUCCESS) continue;
      if (got) *got = has;
      return allocated;
    }
  throw std::runtime_error("found no Vulkan memory for " + std::to_string(needed.size) + " bytes");
}

void Device::submit(const std::function<void(VkCommandBuffer)>& record) const {
  check(ResetCommandPool(device_, pool_, 0), "vkResetCommandPool");
  const VkCommandBufferBeginInfo once = {VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO, nullptr,
                                         VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT, nullptr};
  check(BeginCommandBuffer(commands_, &once), "vkBeginCommandBuffer");
  record(commands_);
  check(EndCommandBuffer(commands_), "vkEndCommandBuffer");
  VkSubmitInfo submission = {};
  submission.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
  submission.commandBufferCount = 1;
  submission.pCommandBuffers = &commands_;
  check(QueueSubmit(queue_, 1, &submission, fence_), "vkQueueSubmit");
  check(WaitForFences(device_, 1, &fence_, VK_TRUE, kLongest), "vkWaitForFences");
  check(ResetFences(device_, 1, &fence_), "vkResetFences");
}

}  // namespace test_runtime
