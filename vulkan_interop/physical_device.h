#pragma once
// What a physical device has of what the hand-off can use.
#include <array>
#include <cstdint>
#include <set>
#include <string>

#include "vulkan_interop/functions.h"

namespace voyager::vulkan {

inline constexpr uint32_t kLeastVersion = VK_API_VERSION_1_1;

class PhysicalDevice {
 public:
  // Throws Error(unsupported) for a device older than kLeastVersion.
  PhysicalDevice(PFN_vkGetInstanceProcAddr get, VkInstance instance, VkPhysicalDevice device);

  const InstanceFunctions& functions() const { return vk_; }
  const std::array<uint8_t, 16>& uuid() const { return uuid_; }
  // The version that the device itself has.
  uint32_t version() const { return version_; }
  bool has(const char* extension) const { return extensions_.count(extension) != 0; }
  bool has_timelines() const { return timelines_; }
  // Such a semaphore can leave as an opaque file descriptor.
  bool exports_semaphores(bool timeline) const;
  uint64_t host_pointer_alignment() const { return host_pointer_alignment_; }
  const VkPhysicalDeviceMemoryProperties& memory() const { return memory_; }

 private:
  InstanceFunctions vk_;
  VkPhysicalDevice device_;
  std::array<uint8_t, 16> uuid_{};
  uint32_t version_ = 0;
  std::set<std::string> extensions_;
  bool timelines_ = false;
  uint64_t host_pointer_alignment_ = 0;
  VkPhysicalDeviceMemoryProperties memory_{};
};

}  // namespace voyager::vulkan
