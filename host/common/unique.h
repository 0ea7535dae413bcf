#pragma once
// Owners of a device's objects.
#include <vulkan/vulkan.h>

#include <utility>

namespace host {

// Destroyed with its owner, who sees to it that the queue is done with it.
template <class T, void(VKAPI_PTR* destroy)(VkDevice, T, const VkAllocationCallbacks*)>
class Unique {
 public:
  Unique() = default;
  Unique(VkDevice device, T object) : device_(device), object_(object) {}
  Unique(Unique&& other) noexcept
      : device_(other.device_), object_(std::exchange(other.object_, T{})) {}
  Unique& operator=(Unique&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(object_, other.object_);
    return *this;
  }
  ~Unique() {
    if (object_) destroy(device_, object_, nullptr);
  }
  T get() const { return object_; }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  T object_ = VK_NULL_HANDLE;
};

using UniqueCommandPool = Unique<VkCommandPool, vkDestroyCommandPool>;
using UniqueDescriptorPool = Unique<VkDescriptorPool, vkDestroyDescriptorPool>;
using UniqueDescriptorSetLayout = Unique<VkDescriptorSetLayout, vkDestroyDescriptorSetLayout>;
using UniqueFence = Unique<VkFence, vkDestroyFence>;
using UniqueFramebuffer = Unique<VkFramebuffer, vkDestroyFramebuffer>;
using UniqueImageView = Unique<VkImageView, vkDestroyImageView>;
using UniqueMemory = Unique<VkDeviceMemory, vkFreeMemory>;
using UniqueBuffer = Unique<VkBuffer, vkDestroyBuffer>;
using UniqueImage = Unique<VkImage, vkDestroyImage>;
using UniquePipeline = Unique<VkPipeline, vkDestroyPipeline>;
using UniquePipelineLayout = Unique<VkPipelineLayout, vkDestroyPipelineLayout>;
using UniqueRenderPass = Unique<VkRenderPass, vkDestroyRenderPass>;
using UniqueSemaphore = Unique<VkSemaphore, vkDestroySemaphore>;
using UniqueShaderModule = Unique<VkShaderModule, vkDestroyShaderModule>;
using UniqueSwapchain = Unique<VkSwapchainKHR, vkDestroySwapchainKHR>;

}  // namespace host
