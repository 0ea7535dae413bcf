#pragma once
// The state of VulkanMock (vulkan_mock.h), on which its entry points work.
#ifndef VK_NO_PROTOTYPES
#define VK_NO_PROTOTYPES
#endif
#include <gtest/gtest.h>
#include <vulkan/vulkan_core.h>

#include <cstdint>
#include <cstdlib>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/vulkan_commands.h"

namespace voyager::test {

struct MockDevice {
  uint32_t version = VK_API_VERSION_1_2;
  // That it has, and that the host enabled.
  std::vector<std::string> extensions = {
      VK_KHR_EXTERNAL_MEMORY_FD_EXTENSION_NAME, VK_KHR_EXTERNAL_SEMAPHORE_FD_EXTENSION_NAME,
      VK_KHR_TIMELINE_SEMAPHORE_EXTENSION_NAME, VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME,
      VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME};
  bool timelines = true, exports_timelines = true, exports_binaries = true;
  bool exports_buffers = true;
  // Formats of which it shares no images, and of which it exports none.
  VkFormat not_shared = VK_FORMAT_UNDEFINED, not_exported = VK_FORMAT_UNDEFINED;
  uint32_t queue_families = 4;
  uint64_t host_pointer_alignment = 4096;
  // Of host memory: what vkGetMemoryHostPointerPropertiesEXT says, and vkAllocateMemory.
  VkResult host_pointer_status = VK_SUCCESS, host_import_status = VK_SUCCESS;
  uint32_t host_pointer_types = 6;
  std::string missing;  // an entry point that it lacks

  bool has(const std::string& extension) const {
    for (const std::string& own : extensions)
      if (own == extension) return true;
    return false;
  }
  void remove(const std::string& extension) { std::erase(extensions, extension); }
};

class VulkanMock {
 public:
  static constexpr uint32_t kNever = UINT32_MAX;

  struct Object {
    std::string kind;
    uint64_t parent = 0, memory = 0;  // of a view or a set; of an image or a buffer
    uint64_t bytes = 0;
    uint32_t layers = 0, memory_type = 0;
    bool exported = false, host_pointer = false;
    bool timeline = false;
    uint64_t value = 0;
    std::shared_ptr<void> mapped;
  };
  struct Point {
    VkSemaphore semaphore;
    uint64_t value;
  };

  explicit VulkanMock(MockDevice having = {}) : device(std::move(having)) {
    EXPECT_EQ(current, nullptr) << "one at a time";
    current = this;
  }
  ~VulkanMock() { current = nullptr; }
  VulkanMock(const VulkanMock&) = delete;
  VulkanMock& operator=(const VulkanMock&) = delete;

  static PFN_vkVoidFunction VKAPI_CALL get_instance(VkInstance, const char* name);
  static VkInstance instance() { return as<VkInstance>(1); }
  static VkPhysicalDevice physical() { return as<VkPhysicalDevice>(2); }
  static VkDevice handle() { return as<VkDevice>(3); }
  static VkCommandBuffer commands_at(uint64_t i) { return as<VkCommandBuffer>(100 + i); }

  // The call that can fail with so many before it.
  void fail_at(uint32_t call, VkResult with) {
    calls_ = 0;
    fail_at_ = call;
    status_ = with;
    failed_ = false;
  }
  bool failed() const { return failed_; }
  // What such a call returns.
  VkResult next() {
    if (calls_++ != fail_at_) return VK_SUCCESS;
    failed_ = true;
    return status_;
  }

  size_t live() const { return objects.size(); }
  std::string live_kinds() const {
    std::string text;
    for (const auto& [id, object] : objects) text += object.kind + " ";
    return text;
  }
  template <class Handle>
  Object& object(Handle handle) {
    return objects.at(id_of(handle));
  }
  template <class Handle>
  bool has(Handle handle) const {
    return objects.count(id_of(handle)) != 0;
  }
  uint64_t value(VkSemaphore semaphore) { return object(semaphore).value; }
  // The host's queue reaches its signal.
  void signal(VkSemaphore semaphore, uint64_t to) { object(semaphore).value = to; }

  // Of the host: not counted as calls, and its to remove.
  VkSemaphore host_semaphore(bool timeline) {
    Object made;
    made.kind = "VkSemaphore";
    made.timeline = timeline;
    return add<VkSemaphore>(made);
  }
  VkImage host_image(uint32_t layers, uint64_t bytes = 0) {
    Object made;
    made.kind = "VkImage";
    made.layers = layers;
    made.bytes = bytes;
    return add<VkImage>(made);
  }

  template <class Handle>
  Handle add(Object made) {
    objects.emplace(++last_id_, std::move(made));
    return as<Handle>(last_id_);
  }
  template <class Handle>
  static uint64_t id_of(Handle handle) {
    return static_cast<uint64_t>(reinterpret_cast<uintptr_t>(handle));
  }
  template <class Handle>
  static Handle as(uint64_t id) {
    return reinterpret_cast<Handle>(static_cast<uintptr_t>(id));
  }

  MockDevice device;
  std::map<uint64_t, Object> objects;
  std::vector<Command> commands;
  std::vector<Point> waits, signals;  // vkWaitSemaphores, vkSignalSemaphore
  std::map<VkDescriptorSet, std::vector<VkImageView>> written;
  static inline VulkanMock* current = nullptr;

 private:
  uint64_t last_id_ = 1000;
  uint32_t calls_ = 0, fail_at_ = kNever;
  VkResult status_ = VK_SUCCESS;
  bool failed_ = false;
};

}  // namespace voyager::test
