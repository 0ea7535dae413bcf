#pragma once
// What a host's VkInstance and VkDevice are made with: what Voyager asks for, and what the host
// adds. The host, or an OpenXR runtime in its place, makes them.
#include <voyager/voyager_vulkan.h>

#include <vector>

#include "validation.h"

namespace host {

class InstanceCreation {
 public:
  // Asks Voyager, before there is an instance. `application` is what drivers call the program.
  // validation may be NULL. Vulkan 1.1, or what Voyager needs.
  InstanceCreation(const char* application, Validation* validation,
                   const std::vector<const char*>& own_extensions);
  InstanceCreation(const InstanceCreation&) = delete;
  InstanceCreation& operator=(const InstanceCreation&) = delete;

  uint32_t api_version() const { return application_.apiVersion; }
  void set_api_version(uint32_t version) { application_.apiVersion = version; }
  const VkInstanceCreateInfo& info() const { return info_; }

 private:
  std::vector<const char*> extensions_;
  VkApplicationInfo application_ = {};
  VkInstanceCreateInfo info_ = {};
};

// A device with one queue.
class DeviceCreation {
 public:
  // Asks Voyager what it can use of what this physical device has.
  DeviceCreation(VkInstance instance, uint32_t api_version, VkPhysicalDevice physical,
                 uint32_t queue_family, const std::vector<const char*>& own_extensions);
  DeviceCreation(const DeviceCreation&) = delete;
  DeviceCreation& operator=(const DeviceCreation&) = delete;

  const VkDeviceCreateInfo& info() const { return info_; }
  // What voyCreateDevice needs to know of the device that was made so. It points into this object.
  VoyVulkanDeviceDesc voyager_desc(VkDevice device) const;

 private:
  VoyVulkanDeviceDesc desc_ = VOY_VULKAN_DEVICE_DESC_INIT;
  std::vector<const char*> extensions_;
  float priority_ = 1;
  VkDeviceQueueCreateInfo queue_ = {};
  VkPhysicalDeviceTimelineSemaphoreFeatures timeline_ = {};
  VkDeviceCreateInfo info_ = {};
};

}  // namespace host
