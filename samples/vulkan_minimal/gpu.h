#pragma once
// The engine's own Vulkan: an instance and a device with what Voyager can use, one queue, an image,
// and commands.
#include <voyager/voyager_vulkan.h>
#include <vulkan/vulkan.h>

#include <functional>
#include <vector>

// Throws std::runtime_error, which names the call, for anything but VK_SUCCESS.
void check(VkResult result, const char* call);

struct Gpu {
  Gpu();
  ~Gpu();
  Gpu(const Gpu&) = delete;
  Gpu& operator=(const Gpu&) = delete;

  // For VoyDeviceDesc.next.
  VoyVulkanDeviceDesc voyager_desc() const;
  uint32_t memory_type(uint32_t types, VkMemoryPropertyFlags flags) const;
  // Records, submits and waits until the GPU has finished. The submission waits for `wait` to reach
  // its value at ALL_COMMANDS and signals `signal`; a NULL semaphore is none.
  struct Point {
    VkSemaphore timeline = VK_NULL_HANDLE;
    uint64_t value = 0;
  };
  void run(const Point& wait, const Point& signal,
           const std::function<void(VkCommandBuffer)>& record) const;

  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  VkQueue queue = VK_NULL_HANDLE;
  uint32_t queue_family = 0;

 private:
  void make_instance();
  void make_device();

  std::vector<const char*> extensions_;
  VkBool32 timelines_ = VK_FALSE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
};

// RGBA8 of the engine's, and a mapped buffer to read it.
struct Picture {
  Picture(const Gpu& gpu, VkExtent2D extent);
  ~Picture();
  Picture(const Picture&) = delete;
  Picture& operator=(const Picture&) = delete;

  void barrier(VkCommandBuffer commands, VkImageLayout from, VkImageLayout to) const;
  std::vector<unsigned char> read() const;  // in TRANSFER_SRC_OPTIMAL

  const Gpu& gpu;
  VkExtent2D extent;
  VkImage image = VK_NULL_HANDLE;
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memories[2] = {};
  void* mapped = nullptr;
};
