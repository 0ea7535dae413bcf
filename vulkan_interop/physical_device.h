#pragma once
// What a physical device has of what the hand-off can use.
#include <array>
#include <cstdint>
#include <set>
#include <string>

#include "vulkan_interop/functions.h"

namespace voyager::vulkan {

inline constexpr uint32_t kLeastVersion = VK_API_VERSION_1_1;
// Of the images and buffers that Voyager makes to share.
inline constexpr VkImageUsageFlags kImageUsage =
    VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
inline constexpr VkBufferUsageFlags kBufferUsage =
    VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

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
  // An image of a ring, or a buffer for its depth limits, can leave as an opaque file descriptor.
  bool exports_images(VkFormat format) const;
  bool exports_buffers() const;
  // Such a semaphore can leave as an opaque file descriptor.
  bool exports_semaphores(bool timeline) const;
  // Images of the format, one of Vulkan 1.0, have all of the features.
  bool draws_to(VkFormat format, VkFormatFeatureFlags features) const;
  uint64_t host_pointer_alignment() const { return host_pointer_alignment_; }
  const VkPhysicalDeviceMemoryProperties& memory() const { return memory_; }
  uint32_t queue_families() const { return queue_families_; }

 private:
  InstanceFunctions vk_;
  VkPhysicalDevice device_;
  std::array<uint8_t, 16> uuid_{};
  uint32_t version_ = 0;
  std::set<std::string> extensions_;
  bool timelines_ = false;
  uint64_t host_pointer_alignment_ = 0;
  VkPhysicalDeviceMemoryProperties memory_{};
  uint32_t queue_families_ = 0;
};

}  // namespace voyager::vulkan
