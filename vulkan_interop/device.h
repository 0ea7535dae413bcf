#pragma once
// The host's Vulkan device, and how it and a backend share images and wait for one another.
#include <string>
#include <vector>

#include "runtime/frame/external_ring.h"
#include "vulkan_interop/physical_device.h"

namespace voyager::vulkan {

enum class Sharing { automatic, device, host };
enum class Sync { automatic, timeline, binary, host };

struct DeviceDesc {
  PFN_vkGetInstanceProcAddr get = nullptr;
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical_device = VK_NULL_HANDLE;
  VkDevice device = VK_NULL_HANDLE;
  uint32_t version = 0;  // of the instance
  std::vector<std::string> extensions;
  bool timelines = false;
  Sharing sharing = Sharing::automatic;
  Sync sync = Sync::automatic;
};

class Device {
 public:
  // Throws Error(unsupported) where a mode that is asked for cannot be.
  Device(const DeviceDesc& desc, const ExternalSupport& backend);

  VkDevice handle() const { return device_; }
  const DeviceFunctions& functions() const { return vk_; }
  const PhysicalDevice& physical() const { return physical_; }
  Sharing sharing() const { return sharing_; }
  Sync sync() const { return sync_; }
  // A pipeline without a render pass can be made.
  bool has_dynamic_rendering() const {
    return enabled(VK_KHR_DYNAMIC_RENDERING_EXTENSION_NAME) ||
           (version_ >= VK_API_VERSION_1_3 && physical_.version() >= VK_API_VERSION_1_3);
  }
  // With HOST sharing: it takes memory of the host's, as a page that was tried has shown.
  bool imports_host_memory() const { return imports_host_memory_; }
  // What keeps it from sharing images, or from timelines; "" if nothing.
  const std::string& why() const { return why_; }

 private:
  bool enabled(const char* extension) const;
  std::string why_not_shared(const ExternalSupport& backend) const;
  std::string why_no_timelines(const ExternalSupport& backend) const;
  std::string why_no_binaries(const ExternalSupport& backend) const;
  void choose_sharing(Sharing wanted, const ExternalSupport& backend);
  void choose_sync(Sync wanted, const ExternalSupport& backend);

  PhysicalDevice physical_;
  VkDevice device_;
  DeviceFunctions vk_;
  std::vector<std::string> extensions_;
  uint32_t version_;  // of the instance
  bool timelines_;
  bool imports_host_memory_ = false;
  Sharing sharing_ = Sharing::host;
  Sync sync_ = Sync::host;
  std::string why_;
};

}  // namespace voyager::vulkan
